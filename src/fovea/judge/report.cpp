#include "fovea/judge/report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "fovea/io/image_codec.h"
#include "fovea/io/uri.h"
#include "fovea/judge/report_page.h"

namespace fovea {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kQuality = 88;  // of pictures: what it loses does not show beside what simplifying loses

std::string data_uri(const Image8& image) {
  return "data:image/webp;base64," + encode_base64(encode_webp(image, kQuality));
}

Image8 heat_of(const Plane& plane) {
  Image8 image(plane.width, plane.height, 3, ColorEncoding::srgb);
  for (std::size_t i = 0; i < plane.values.size(); ++i) {
    const auto color = heat_color(plane.values[i]);
    std::copy(color.begin(), color.end(), image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return image;
}

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json json_of(const ImageScores& s) {
  return {{"flip", s.flip},
          {"flip_fg", s.flip_foreground},
          {"ms_ssim", s.ms_ssim},
          {"ssim", s.ssim},
          {"ms_ssim_fg", s.ms_ssim_foreground},
          {"psnr", number(s.psnr)},
          {"psnr_fg", number(s.psnr_foreground)}};
}

Json json_of(const ReportModel& m) {
  return {{"name", m.name},
          {"triangles", m.triangles},
          {"vertices", m.vertices},
          {"bytes",
           {{"geometry", m.bytes.geometry},
            {"images", m.bytes.images},
            {"animation", m.bytes.animation},
            {"other", m.bytes.other}}}};
}

Json json_of(const Comparison& c) {
  Json views = Json::array();
  for (const ViewComparison& view : c.views)
    views.push_back(
        {{"base", json_of(view.passes[0])}, {"lit", json_of(view.passes[1])}, {"iou", view.silhouette_iou}});
  const auto share = [&](auto distance) {
    return c.distance ? number(distance(*c.distance) / c.reference_diagonal) : Json("");
  };
  return {{"base", json_of(c[JudgedPass::base_color])},
          {"lit", json_of(c[JudgedPass::lit])},
          {"iou", c.silhouette_iou},
          {"mean", share([](const SurfaceDistance& d) { return d.mean(); })},
          {"hausdorff", share([](const SurfaceDistance& d) { return d.hausdorff(); })},
          {"views", std::move(views)}};
}

/// JSON that can stand inside a script element whatever names it holds.
std::string script_text(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string safe;
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace

CompareObserver CompareReport::observer() {
  CompareObserver observer;
  observer.begin = [this](std::size_t views, std::size_t tests) {
    reference_.assign(views, {});
    tests_.assign(views, std::vector<Shown>(tests));
  };
  observer.pictures = [this](std::size_t view, std::size_t test, JudgedPass pass, const Picture& reference,
                             const Picture& picture, const Plane& flip) {
    const auto slot = [pass](Shown& shown) -> std::string& {
      return pass == JudgedPass::lit ? shown.lit : shown.base_color;
    };
    // Of one view all tests come from one thread.
    if (test == 0) slot(reference_[view]) = data_uri(reference.color);
    Shown& shown = tests_[view][test];
    slot(shown) = data_uri(picture.color);
    if (pass == JudgedPass::lit) shown.flip = data_uri(heat_of(flip));
  };
  observer.distances = [this](std::size_t view, std::size_t test, const Picture& heat) {
    tests_[view][test].distance = data_uri(heat.color);
  };
  return observer;
}

std::string CompareReport::html(const ReportModel& reference, std::span<const ReportModel> tests,
                                std::span<const Comparison> found) const {
  Json data;
  data["reference"] = json_of(reference);
  data["hottest"] = kHottestDistance;
  data["tests"] = Json::array();
  for (std::size_t t = 0; t < tests.size(); ++t) {
    Json test = json_of(tests[t]);
    test["scores"] = json_of(found[t]);
    data["tests"].push_back(std::move(test));
  }
  data["views"] = Json::array();
  for (std::size_t v = 0; v < reference_.size(); ++v) {
    Json shown = Json::array();
    for (const Shown& s : tests_[v])
      shown.push_back({{"base", s.base_color}, {"lit", s.lit}, {"flip", s.flip}, {"distance", s.distance}});
    data["views"].push_back({{"name", found.empty() ? "" : found[0].views[v].name},
                             {"base", reference_[v].base_color},
                             {"lit", reference_[v].lit},
                             {"tests", std::move(shown)}});
  }
  std::string page = kReportPage;
  const std::string place = "/*DATA*/null";
  return page.replace(page.find(place), place.size(), script_text(data));
}
}  // namespace fovea
