#include "fovea/io/image_decoder.h"

#include <gtest/gtest.h>

#include "fovea/io/image_codec.h"

namespace fovea {
namespace {

TEST(ImageDecoder, DecodesAndSaysOnceWhatItCannot) {
  Model model;
  model.images.resize(2);
  model.images[0].bytes = encode_png(Image8(3, 2, 3, ColorEncoding::srgb));
  model.images[1].bytes = {1, 2, 3};
  ImageDecoder decoder(model);
  Context context;
  const auto image = decoder.decode(0, context);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width, 3);
  EXPECT_TRUE(context.diagnostics().empty());
  EXPECT_FALSE(decoder.decode(1, context));
  EXPECT_FALSE(decoder.decode(1, context));
  ASSERT_EQ(context.diagnostics().size(), 1u);
  EXPECT_EQ(context.diagnostics()[0].code, "image-not-shown");
  EXPECT_EQ(context.diagnostics()[0].count, 1u);
}

}  // namespace
}  // namespace fovea
