#pragma once

#include <string>
#include <vector>

#include "fovea/io/gltf_buffer_write.h"
#include "fovea/model/model.h"

// Private to io: where a glTF file keeps its images.

namespace fovea::gltf {

/// "model 1.bin" -> "model%201.bin"; "/" stays.
std::string percent_encode(const std::string& path);

/// File name extension, with the dot, of an image type; that of PNG for an unknown one.
std::string image_suffix(const std::string& mime_type);

/// Type of an image: by its content, else as the model says.
std::string image_type(const EncodedImage& image);

/// Image objects of a GLB; the images go into views.
Json embed_images(const std::vector<EncodedImage>& images, BufferWriter& buffers);

/// Image objects of a .gltf; the images go into `files`, under the relative path that they came with if it
/// stays inside the folder and fits the type, else as `stem`_image<i>. Equal names get different ones
/// unless the images are equal.
Json image_files(const std::vector<EncodedImage>& images, const std::string& stem,
                 std::vector<OutputFile>& files, ByteCounts& counts);

}  // namespace fovea::gltf
