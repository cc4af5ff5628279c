#include "shrink_text.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "report.h"
#include "text.h"

namespace fovea::cli {

namespace {

/// By SizeReason.
constexpr std::array kReasons{"none", "asked", "seen", "bytes"};

std::string format_name(const std::string& mime_type) {
  return mime_type.rfind("image/", 0) == 0 ? mime_type.substr(6) : "unknown";
}

std::string state_text(const ImageChange::State& s) {
  return fmt::format("{} × {} {}, {}", s.width, s.height, format_name(s.mime_type), bytes_text(s.bytes));
}

Json state_json(const ImageChange::State& s) {
  return {{"mime_type", s.mime_type}, {"width", s.width}, {"height", s.height}, {"bytes", s.bytes}};
}

std::string name_of(const Model& model, std::size_t image) {
  const std::string& name = model.images[image].name;
  return name.empty() ? fmt::format("image {}", image) : printable(name);
}

std::string encoding_text(double psnr_db) {
  return std::isfinite(psnr_db) ? fmt::format(" ({:.1f} dB)", psnr_db) : " (without loss)";
}

std::string reason_text(SizeReason reason, std::optional<double> per_pixel) {
  switch (reason) {
    case SizeReason::seen:
      return per_pixel ? fmt::format(", seen at {:.2g} texels per pixel", *per_pixel) : ", not seen";
    case SizeReason::bytes: return ", for the bytes";
    case SizeReason::asked:
    case SizeReason::none: break;
  }
  return "";
}

std::string tell_images(Session& session, const Shrunk& result,
                        std::span<const std::optional<double>> texels_per_pixel) {
  Json& images = session.report["images"] = Json::array();
  TextTable table("lll");
  for (std::size_t i = 0; i < result.images.size(); ++i) {
    const ImageChange& change = result.images[i];
    const bool encoded = change.psnr_db != 0;
    const std::optional<double> per_pixel = i < texels_per_pixel.size() ? texels_per_pixel[i] : std::nullopt;
    images.push_back({{"image", i},
                      {"name", result.model.images[i].name},
                      {"before", state_json(change.before)},
                      {"after", state_json(change.after)},
                      {"psnr_db", encoded ? number_json(change.psnr_db) : Json()},
                      {"reason", kReasons[static_cast<std::size_t>(change.reason)]},
                      {"texels_per_pixel", per_pixel ? number_json(*per_pixel) : Json()},
                      {"kept_because", change.kept_because}});
    std::string what = "as it was";
    if (!change.kept_because.empty()) what += ": " + printable(change.kept_because);
    if (encoded)
      what = "-> " + state_text(change.after) + encoding_text(change.psnr_db) +
             reason_text(change.reason, per_pixel);
    const bool is_new = change.before.bytes == 0;
    table.row({name_of(result.model, i), is_new ? "new" : state_text(change.before), what});
  }
  return table.text(0);
}

std::string moves_text(const AtlasChange& atlas) {
  if (!atlas.fixed_because.empty()) return fmt::format("not moved: {}", printable(atlas.fixed_because));
  return fmt::format("moved, which loses {:.0f} % of what resizing alone would",
                     100 * atlas.loss / atlas.plain_loss);
}

std::string rebake_text(const AtlasChange& atlas) {
  if (!atlas.not_rebaked_because.empty())
    return fmt::format("not baked anew: {}", printable(atlas.not_rebaked_because));
  return fmt::format("baked anew, {:.0f} % of the texels from elsewhere", 100 * atlas.rebaked_texels);
}

std::string tell_atlases(Session& session, const std::vector<AtlasChange>& atlases, bool rebake) {
  Json& list = session.report["atlases"] = Json::array();
  std::string text;
  for (const AtlasChange& atlas : atlases) {
    const bool measured = atlas.plain_loss > 0;
    Json& json = list.emplace_back(Json{{"images", atlas.images},
                                        {"fixed_because", atlas.fixed_because},
                                        {"floor", atlas.floor},
                                        {"rounds", atlas.rounds},
                                        {"last_move_cells", atlas.last_move},
                                        {"settled", atlas.settled},
                                        {"loss", measured ? number_json(atlas.loss) : Json()},
                                        {"plain_loss", measured ? number_json(atlas.plain_loss) : Json()}});
    if (rebake) {
      json["not_rebaked_because"] = atlas.not_rebaked_because;
      json["rebaked_texels"] = atlas.rebaked_texels;
    }
    text += fmt::format("texels   of image{} {}: {}{}\n", atlas.images.size() > 1 ? "s" : "",
                        fmt::join(atlas.images, ", "), rebake ? rebake_text(atlas) + "; " : "",
                        moves_text(atlas));
  }
  return text;
}

}  // namespace

std::string tell_shrunk(Session& session, const Shrunk& result, bool rebake,
                        std::span<const std::optional<double>> texels_per_pixel) {
  const std::string images = tell_images(session, result, texels_per_pixel);
  return images + tell_atlases(session, result.atlases, rebake);
}

}  // namespace fovea::cli
