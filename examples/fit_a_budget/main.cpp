// One model in several sizes, each as good as its bytes allow: fit_a_budget INPUT OUTPUT-STEM KILOBYTES...
// writes OUTPUT-STEM-200kb.glb and so on. The model is measured once; each size after the first costs little.

#include <cstdlib>
#include <iostream>
#include <string>

#include "fovea/base/error.h"
#include "fovea/budget/fit.h"
#include "fovea/io/read.h"
#include "fovea/io/write.h"

int main(int count, char** words) {
  if (count < 4) {
    std::cerr << "usage: fit_a_budget INPUT OUTPUT-STEM KILOBYTES...\n";
    return 2;
  }
  try {
    fovea::Context context;
    const fovea::Model model = fovea::read_model(words[1], {}, context);

    fovea::FitOptions options;
    options.form.write.quantize = true;
    options.view_size = 256;  // pixels along the pictures that decide: as large as it will be seen
    fovea::BudgetFit fit(model, options, context);

    for (int i = 3; i < count; ++i) {
      const std::uint64_t bytes = 1000 * std::strtoull(words[i], nullptr, 10);
      const fovea::FitResult result = fit.within(bytes);
      if (!result.reached) {
        std::cerr << "no file takes " << bytes << " bytes: the smallest takes " << result.chosen.bytes
                  << '\n';
        return 8;
      }
      const std::string path = std::string(words[2]) + "-" + words[i] + "kb.glb";
      fovea::write_model(result.model, path, options.form.write, context);
      std::cout << path << ": " << result.chosen.bytes << " bytes, " << result.chosen.triangles
                << " triangles, " << result.chosen.image_bytes << " bytes of images, "
                << result.chosen.psnr_db << " dB from the original\n";
    }
    return 0;
  } catch (const fovea::Error& error) {
    std::cerr << error.what() << '\n';
    return fovea::exit_code(error.kind());
  }
}
