#include "report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "fovea/base/text.h"
#include "text.h"

namespace fovea::cli {

namespace {

struct ToJson {
  Json operator()(const bool* v) const { return *v; }
  Json operator()(const std::int64_t* v) const { return *v; }
  Json operator()(const double* v) const { return number_json(*v); }
  Json operator()(const std::string* v) const { return *v; }
  Json operator()(const std::vector<std::string>* v) const { return *v; }
  Json operator()(const std::optional<std::int64_t>* v) const { return v->has_value() ? Json(**v) : Json(); }
  Json operator()(const std::optional<double>* v) const { return v->has_value() ? number_json(**v) : Json(); }
  Json operator()(const Option::Choice& c) const { return c.names.at(static_cast<std::size_t>(c.get())); }
};

Json to_json(const FileBytes& bytes) {
  return {{"files", bytes.files},
          {"geometry", bytes.kinds.geometry},
          {"images", bytes.kinds.images},
          {"animation", bytes.kinds.animation},
          {"other", bytes.kinds.other}};
}

}  // namespace

Json number_json(double number) { return std::isfinite(number) ? Json(number) : Json(); }

Json report_head(const std::string& verb) {
  return {{"schema_version", kReportSchema},
          {"tool", {{"name", "fovea"}, {"version", FOVEA_VERSION}}},
          {"verb", verb}};
}

Json options_json(const Arguments& arguments) {
  Json json = Json::object();
  for (const OptionGroup& group : arguments.groups()) {
    for (const Option& option : group.options) json[option.name] = std::visit(ToJson{}, option.value);
  }
  return json;
}

Json diagnostics_json(const std::vector<Diagnostic>& diagnostics) {
  Json json = Json::array();
  for (const Diagnostic& d : diagnostics) {
    json.push_back({{"code", d.code}, {"message", d.message}, {"place", d.place}, {"count", d.count}});
  }
  return json;
}

Json error_json(const Error& error) {
  return {{"kind", to_string(error.kind())},
          {"message", error.message()},
          {"place", error.place()},
          {"hint", error.hint()}};
}

Snapshot snapshot(const Model& model, const FileBytes& bytes) {
  Snapshot s{counts(model), 0, bytes};
  for (const Mesh& mesh : model.meshes) s.parts += mesh.surface.parts.size();
  return s;
}

Json to_json(const Snapshot& s) {
  return {{"triangles", s.counts.triangles},
          {"triangles_drawn", s.counts.triangles_drawn},
          {"vertices", s.counts.vertices},
          {"split_vertices", s.counts.split_vertices},
          {"parts", s.parts},
          {"bytes_by_kind", to_json(s.bytes)}};
}

Json file_json(const std::string& path, const FileBytes& bytes) {
  return {{"path", path}, {"format", to_string(bytes.format)}, {"bytes", bytes.files}};
}

Json file_json(const std::string& path) {
  std::error_code ignored;
  const std::uintmax_t bytes = std::filesystem::file_size(path, ignored);
  return {{"path", path}, {"format", lower_extension(path).substr(1)}, {"bytes", ignored ? 0 : bytes}};
}

std::string comparison_text(const Snapshot& before, const Snapshot& after) {
  TextTable table("lr");
  table.row({"", "before", "after", ""});
  const auto row = [&](const char* name, std::uint64_t b, std::uint64_t a, const auto& text) {
    if (b != 0 || a != 0) table.row({name, text(b), text(a), percent_text(a, b)});
  };
  row("triangles", before.counts.triangles, after.counts.triangles, count_text);
  if (before.counts.triangles_drawn != before.counts.triangles) {
    row("triangles drawn", before.counts.triangles_drawn, after.counts.triangles_drawn, count_text);
  }
  row("vertices", before.counts.vertices, after.counts.vertices, count_text);
  row("split vertices", before.counts.split_vertices, after.counts.split_vertices, count_text);
  row("geometry", before.bytes.kinds.geometry, after.bytes.kinds.geometry, bytes_text);
  row("images", before.bytes.kinds.images, after.bytes.kinds.images, bytes_text);
  row("animation", before.bytes.kinds.animation, after.bytes.kinds.animation, bytes_text);
  row("file", before.bytes.files, after.bytes.files, bytes_text);
  return table.text(0);
}

std::string dump(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace); }

}  // namespace fovea::cli
