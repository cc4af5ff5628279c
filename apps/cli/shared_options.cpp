#include "shared_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/base/text.h"
#include "fovea/judge/compare.h"
#include "text.h"

namespace fovea::cli {

Option taken(const OptionList& options, const std::string& name, Option::Value value) {
  const auto at =
      std::find_if(options.begin(), options.end(), [&](const Option& o) { return o.name == name; });
  if (at == options.end()) throw Error(ErrorKind::internal, "no such option", "--" + name);
  Option option = *at;
  option.value = std::move(value);
  return option;
}

Positional model_argument(std::string& path) {
  return {"MODEL", "A model file: glTF, GLB, OBJ, PLY, STL, FBX, ...", &path};
}

Option describe_output(std::string& path) {
  return {"output", "File to write; its extension picks the format.", &path, "output"};
}

Option describe_force(bool& force) {
  WriteOptions model;
  return taken(describe(model), "force", &force);
}

Option describe_view_size(std::int64_t& size) {
  CompareOptions compare;
  return taken(describe(compare), "view-size", &size);
}

Option describe_columns(std::int64_t& columns) {
  return {"columns", "Views side by side in a sheet; 0 makes it about square.", &columns, "", 0, 4096};
}

Option describe_field(const std::string& name, const std::string& help, std::string& source) {
  return {
      name,
      help + ": a .npy, .csv or .txt file, or the name of a vertex attribute such as _IMPORTANCE or COLOR_0.",
      &source, "file or name"};
}

void need_format(Arguments& arguments, const WriteOptions& options) {
  arguments.need({{"position-bits", "uv-bits", "normal-bits", "color-bits"}, "--quantize", [&options] {
                    return options.quantize;
                  }});
}

void need_views(Arguments& arguments, const ViewOptions& views) {
  arguments.need({{"view-count"}, "--views fibonacci, orbit or cameras", [&views] {
                    return views.set == ViewSet::fibonacci || views.set == ViewSet::orbit ||
                           views.set == ViewSet::cameras;
                  }});
  arguments.need({{"elevation"}, "--views orbit", [&views] { return views.set == ViewSet::orbit; }});
}

std::uint64_t parse_bytes(const std::string& option, const std::string& text) {
  constexpr std::array<std::pair<const char*, double>, 8> kUnits{{{"", 1},
                                                                  {"b", 1},
                                                                  {"kb", 1e3},
                                                                  {"mb", 1e6},
                                                                  {"gb", 1e9},
                                                                  {"kib", 1024.0},
                                                                  {"mib", 1024.0 * 1024},
                                                                  {"gib", 1024.0 * 1024 * 1024}}};
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  std::string unit(static_cast<const char*>(end), text.data() + text.size());
  std::erase(unit, ' ');
  const auto at =
      std::ranges::find(kUnits, lower_case(unit), [](const auto& u) { return std::string(u.first); });
  const double bytes = at == kUnits.end() ? 0 : number * at->second;
  if (error != std::errc() || !(bytes >= 1 && bytes < 1e15)) {
    throw Error(ErrorKind::usage, fmt::format("'{}' is no number of bytes", printable(text)), option,
                "write for example 500KB, 1.5MB or 300000");
  }
  return static_cast<std::uint64_t>(bytes);
}

Option describe_bytes(const std::string& help, std::string& text) { return {"bytes", help, &text, "size"}; }

std::vector<std::uint64_t> parse_byte_list(const std::string& option, const std::string& text) {
  std::vector<std::uint64_t> numbers;
  for (const std::string& part : split_list(text)) {
    numbers.push_back(parse_bytes(option, part));
    if (numbers.size() > 1 && numbers.back() >= numbers[numbers.size() - 2])
      throw Error(ErrorKind::usage, "numbers of bytes do not fall", option, "give the largest first");
  }
  return numbers;
}

std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t least,
                                  std::size_t most) {
  std::vector<double> numbers;
  bool good = true;
  for (const std::string& part : split_list(text)) {
    double number = 0;
    const auto [rest, error] = std::from_chars(part.data(), part.data() + part.size(), number);
    good = good && error == std::errc() && rest == part.data() + part.size() && std::isfinite(number);
    numbers.push_back(number);
  }
  if (!good || numbers.size() < least || numbers.size() > most) {
    const std::string count = least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
    throw Error(ErrorKind::usage, fmt::format("'{}' is not a value for it", printable(text)), "--" + option,
                fmt::format("write {} numbers with commas between them", count));
  }
  return numbers;
}

}  // namespace fovea::cli
