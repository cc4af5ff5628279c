#include "lods_text.h"

#include <fmt/format.h>

#include <charconv>

#include "fovea/base/error.h"
#include "text.h"

namespace fovea::cli {

namespace {

template <class T>
std::vector<T> parse_list(const std::string& text, const std::string& option, const char* example) {
  std::vector<T> numbers;
  if (text.empty()) return numbers;
  for (const std::string& part : split_list(text)) {
    T number{};
    const auto [rest, fault] = std::from_chars(part.data(), part.data() + part.size(), number);
    if (fault != std::errc() || rest != part.data() + part.size()) {
      throw Error(ErrorKind::usage, fmt::format("'{}' is not a list of numbers", text), "--" + option,
                  fmt::format("write them with commas between: --{} {}", option, example));
    }
    numbers.push_back(number);
  }
  return numbers;
}

std::string metric_text(const LodChain& chain) {
  if (chain.metric_from == 0) return to_string(chain.metric);
  return fmt::format("{} from {} on, quadric before", to_string(chain.metric),
                     plural(chain.metric_from, "triangle", "triangles"));
}

}  // namespace

std::vector<double> number_list(const std::string& text, const std::string& option) {
  return parse_list<double>(text, option, "0.5,0.25,0.1");
}

std::vector<std::int64_t> count_list(const std::string& text, const std::string& option) {
  return parse_list<std::int64_t>(text, option, "10000,3000,500");
}

std::string levels_text(const LodChain& chain, const std::vector<LodFile>& files) {
  TextTable table("r");
  table.row({"level", "triangles", "geometry", "images", "file", "error", "mean error", "from distance",
             "coverage", "pixels high", "FLIP", "PSNR"});
  for (std::size_t i = 0; i < chain.levels.size(); ++i) {
    const LodLevel& level = chain.levels[i];
    std::vector<std::string> row{std::to_string(i), count_text(level.triangles),
                                 bytes_text(files[i].bytes.geometry), bytes_text(files[i].bytes.images),
                                 bytes_text(files[i].glb.size())};
    if (i > 0) {
      row.push_back(fmt::format("{:.3g} %", 100 * level.error.max / chain.diagonal));
      row.push_back(fmt::format("{:.2g} %", 100 * level.error.mean / chain.diagonal));
      row.push_back(number_text(level.distance));
      row.push_back(fmt::format("{:.3g}", level.coverage));
    }
    if (level.picture_size > 0) {
      row.push_back(std::to_string(level.picture_size));
      row.push_back(fmt::format("{:.4f}", level.pictures[1].flip));
      row.push_back(fmt::format("{:.1f} dB", level.pictures[1].psnr));
    }
    table.row(std::move(row));
  }
  return table.text(0) + fmt::format("metric   {}\n", metric_text(chain));
}

}  // namespace fovea::cli
