// The smallest program that simplifies a model: simplify_a_model INPUT OUTPUT.

#include <iostream>

#include "fovea/base/error.h"
#include "fovea/io/read.h"
#include "fovea/io/write.h"
#include "fovea/simplify/simplify.h"

int main(int count, char** words) {
  if (count != 3) {
    std::cerr << "usage: simplify_a_model INPUT OUTPUT\n";
    return 2;
  }
  try {
    fovea::Context context;
    const fovea::Model model = fovea::read_model(words[1], {}, context);

    fovea::SimplifyOptions options;
    options.ratio = 0.1;
    const fovea::SimplifyResult result = fovea::simplify(model, options, {}, context);

    fovea::write_model(result.model, words[2], {}, context);
    std::cout << result.triangles_before << " triangles became " << result.triangles_after << ", error "
              << result.error_abs << " in scene units\n";
    for (const fovea::Diagnostic& d : context.diagnostics()) {
      std::cerr << d.place << ": " << d.message << " (" << d.count << ")\n";
    }
    return 0;
  } catch (const fovea::Error& error) {
    std::cerr << error.what() << '\n';
    return fovea::exit_code(error.kind());
  }
}
