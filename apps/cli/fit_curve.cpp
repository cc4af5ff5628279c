#include "fit_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/io/image_codec.h"
#include "fovea/io/uri.h"
#include "fovea/render/render.h"
#include "fovea/render/scene.h"
#include "report.h"
#include "text.h"

namespace fovea::cli {

namespace {

constexpr std::size_t kMostPictures = 8;
constexpr int kPictureSize = 256;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : printable(text)) {
    switch (c) {
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '&': out += "&amp;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  }
  return out;
}

std::string likeness_text(const FitPoint& point) {
  return std::isfinite(point.psnr_db) ? fmt::format("{:.2f} dB", point.psnr_db)
                                      : std::string("as the original");
}

std::string caption(const FitPoint& point) {
  return fmt::format("{}: {} triangles, {} of images, {}", bytes_text(point.bytes),
                     count_text(point.triangles), bytes_text(point.image_bytes), likeness_text(point));
}

/// Bytes to the right, by their logarithm, and decibels upwards.
class Chart {
 public:
  explicit Chart(const FitCurve& curve) {
    for (const auto* points : {&curve.way, &curve.all, &curve.chosen})
      for (const FitPoint& point : *points) include(point);
    if (!(low_db_ < high_db_)) low_db_ -= 1, high_db_ = low_db_ + 2;
    if (!(low_ < high_)) high_ = low_ + 1;
  }

  std::string svg(const FitCurve& curve) const {
    std::string out = fmt::format(
        "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Likeness over bytes\">\n", kWidth, kHeight);
    out += axes();
    for (const FitPoint& point : curve.all) out += dot(point, "all", 2);
    std::string line;
    for (const FitPoint& point : curve.way)
      if (std::isfinite(point.psnr_db)) line += fmt::format("{:.1f},{:.1f} ", x(point), y(point));
    out += fmt::format("<polyline class=\"way\" points=\"{}\"/>\n", line);
    for (const FitPoint& point : curve.way) out += dot(point, "way", 3.5);
    for (const FitPoint& point : curve.chosen) out += dot(point, "chosen", 6);
    return out + "</svg>\n";
  }

 private:
  static constexpr double kWidth = 860, kHeight = 420, kLeft = 60, kBottom = 40, kTop = 15, kRight = 20;

  void include(const FitPoint& point) {
    low_ = std::min(low_, std::log(static_cast<double>(point.bytes)));
    high_ = std::max(high_, std::log(static_cast<double>(point.bytes)));
    if (!std::isfinite(point.psnr_db)) return;
    low_db_ = std::min(low_db_, point.psnr_db);
    high_db_ = std::max(high_db_, point.psnr_db);
  }

  double x(double log_bytes) const {
    return std::lerp(kLeft, kWidth - kRight, (log_bytes - low_) / (high_ - low_));
  }
  double x(const FitPoint& point) const { return x(std::log(static_cast<double>(point.bytes))); }
  double y(double db) const {
    return std::lerp(kHeight - kBottom, kTop, (db - low_db_) / (high_db_ - low_db_));
  }
  /// What is as the original is drawn at the top.
  double y(const FitPoint& point) const { return y(std::isfinite(point.psnr_db) ? point.psnr_db : high_db_); }

  std::string dot(const FitPoint& point, const char* kind, double radius) const {
    return fmt::format(
        "<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"><title>{}</title></circle>\n", kind,
        x(point), y(point), radius, caption(point));
  }

  std::string axes() const {
    std::string out;
    for (double power = std::floor(low_ / std::log(10.0)); power <= high_ / std::log(10.0); ++power) {
      for (const double digit : {1.0, 2.0, 5.0}) {
        const double bytes = digit * std::pow(10.0, power), at = std::log(bytes);
        if (at < low_ || at > high_) continue;
        out += fmt::format(
            "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/><text x=\"{0:.1f}\" "
            "y=\"{3}\" "
            "text-anchor=\"middle\">{4}</text>\n",
            x(at), kTop, kHeight - kBottom, kHeight - kBottom + 18,
            bytes_text(static_cast<std::uint64_t>(bytes)));
      }
    }
    const double range = high_db_ - low_db_;
    const double step = range > 25 ? 10 : range > 8 ? 5 : range > 3 ? 1 : 0.5;
    for (double db = std::ceil(low_db_ / step) * step; db <= high_db_; db += step) {
      out += fmt::format(
          "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/><text x=\"{3}\" "
          "y=\"{4:.1f}\" "
          "text-anchor=\"end\">{5} dB</text>\n",
          kLeft, kWidth - kRight, y(db), kLeft - 6, y(db) + 4, db);
    }
    return out;
  }

  double low_ = INFINITY, high_ = -INFINITY;  // of the logarithm of bytes
  double low_db_ = INFINITY, high_db_ = -INFINITY;
};

std::string table_row(const FitPoint& point, const char* kind) {
  return fmt::format("<tr class=\"{}\"><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", kind,
                     bytes_text(point.bytes), count_text(point.triangles), bytes_text(point.image_bytes),
                     likeness_text(point));
}

constexpr const char* kStyle =
    "body{font:15px/1.4 system-ui,sans-serif;max-width:900px;margin:2em auto;padding:0 1em;color:#222;"
    "background:#fff}svg{width:100%}svg "
    "text{font-size:12px;fill:#555}.grid{stroke:#ddd}polyline.way{fill:none;"
    "stroke:#2563a8;stroke-width:2}circle.way{fill:#2563a8}circle.all{fill:#bbb}circle.chosen{fill:none;"
    "stroke:#d1495b;stroke-width:3}figure{display:inline-block;margin:0 8px 12px 0;width:205px}figure "
    "img{width:100%;height:auto}"
    "figcaption{font-size:12px}table{border-collapse:collapse}td,th{padding:2px "
    "12px;text-align:right;border-bottom:"
    "1px solid #eee}tr.chosen td{color:#d1495b;font-weight:bold}";

}  // namespace

Json to_json(const FitPoint& point) {
  return {{"triangles", point.triangles},
          {"image_bytes", point.image_bytes},
          {"bytes", point.bytes},
          {"loss", number_json(point.loss)},
          {"psnr", number_json(point.psnr_db)}};
}

std::string curve_page(const FitCurve& curve, const std::vector<CurvePicture>& pictures) {
  std::string out = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>{0}: likeness over "
      "bytes</title>\n<style>{1}"
      "</style>\n<h1>{0}</h1>\n<p>What each number of bytes gives, seen at {2} pixels: likeness is the "
      "signal-to-noise ratio of pictures from all around, base colour and lit, over what is covered. "
      "Rings are what was written{3}.</p>\n",
      escaped(curve.title), kStyle, curve.view_size,
      curve.all.empty() ? "" : "; grey are all pairs, blue their lower hull");
  out += Chart(curve).svg(curve);
  for (const CurvePicture& picture : pictures) {
    out += fmt::format(
        "<figure><img alt=\"\" width=\"{0}\" height=\"{0}\" "
        "src=\"data:image/png;base64,{1}\"><figcaption>{2}</figcaption>"
        "</figure>\n",
        kPictureSize, encode_base64(picture.png), caption(curve.way[picture.point]));
  }
  out += "<table>\n<tr><th>bytes</th><th>triangles</th><th>of images</th><th>likeness</th></tr>\n";
  std::size_t told = 0;
  for (const FitPoint& point : curve.way) {
    while (told < curve.chosen.size() && point.bytes <= curve.chosen[told].bytes)
      out += table_row(curve.chosen[told++], "chosen");
    out += table_row(point, "way");
  }
  while (told < curve.chosen.size()) out += table_row(curve.chosen[told++], "chosen");
  return out + "</table>\n</html>\n";
}

std::vector<CurvePicture> curve_pictures(BudgetFit& fit, const std::vector<FitPoint>& way, Context& context) {
  std::vector<CurvePicture> pictures;
  const auto log_bytes = [&](std::size_t i) { return std::log(static_cast<double>(way[i].bytes)); };
  RenderOptions options;
  options.width = options.height = kPictureSize;
  constexpr double kAside = 0.5;  // of a right angle, so that depth shows
  for (std::size_t i = 0; i < way.size(); ++i) {
    const double part = way.size() < 2 || log_bytes(0) <= log_bytes(way.size() - 1)
                            ? 0
                            : (log_bytes(0) - log_bytes(i)) / (log_bytes(0) - log_bytes(way.size() - 1));
    if (part * (kMostPictures - 1) + 1e-9 < static_cast<double>(pictures.size())) continue;
    const Model model = fit.at(i);
    const RenderScene scene = make_render_scene(model, rest_pose(model), context);
    const View view = view_onto(scene.sphere, normalized(Vec3d{kAside, 0.3, 1}), 30, 0);
    pictures.push_back({i, encode_png(render(scene, view, options, context).color)});
  }
  return pictures;
}

}  // namespace fovea::cli
