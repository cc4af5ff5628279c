// The first byte chooses an option, the rest is its value as a user types it.

#include "fovea/base/options.h"
#include "fovea/simplify/simplify.h"
#include "fuzz/fuzz_model.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  SimplifyOptions simplify_options;
  WriteOptions write_options;
  OptionList list = describe(simplify_options);
  for (const Option& option : describe(write_options)) list.push_back(option);
  Option& option = list[data[0] % list.size()];
  fuzz::expect_answer([&] {
    option.parse(std::string(reinterpret_cast<const char*>(data + 1), size - 1));
    option.check();
    const std::string text = option.value_text();
    // What is told is what is meant.
    if (!option.is_flag()) {
      option.parse(text);
      if (option.value_text() != text) std::abort();
    }
  });
  return 0;
}
