#pragma once

#include <string>
#include <vector>

#include "arguments.h"
#include "fovea/base/context.h"
#include "fovea/base/error.h"
#include "fovea/io/file_bytes.h"
#include "fovea/model/model.h"
#include "session.h"

namespace fovea::cli {

/// Version of the JSON report: goes up when a key changes its meaning or goes.
inline constexpr int kReportSchema = 2;

/// What every report begins with: schema version, tool, verb.
Json report_head(const std::string& verb);
/// Every option of the verb with the value it had, under its name.
Json options_json(const Arguments& arguments);
Json diagnostics_json(const std::vector<Diagnostic>& diagnostics);
Json error_json(const Error& error);

/// A model's sizes at one moment, with the bytes of the files that hold it.
struct Snapshot {
  ModelCounts counts;
  std::uint64_t parts = 0;
  FileBytes bytes;
};
Snapshot snapshot(const Model& model, const FileBytes& bytes);
Json to_json(const Snapshot& snapshot);
/// {"path", "format", "bytes"} for "inputs" and "outputs": of a model, and of any other file.
Json file_json(const std::string& path, const FileBytes& bytes);
Json file_json(const std::string& path);
/// Table of what was and what is: triangles, vertices, bytes by kind.
std::string comparison_text(const Snapshot& before, const Snapshot& after);

/// A number for JSON; null if it is not finite.
Json number_json(double number);
/// Text of a report. Names from files may hold broken UTF-8: that is replaced, not refused.
std::string dump(const Json& json);

}  // namespace fovea::cli
