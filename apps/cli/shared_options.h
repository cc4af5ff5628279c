#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "arguments.h"
#include "fovea/io/write.h"
#include "fovea/render/view.h"

namespace fovea::cli {

// Arguments and options that several verbs have, described once.

/// The option of that name with another value behind it.
Option taken(const OptionList& options, const std::string& name, Option::Value value);

Positional model_argument(std::string& path);
Option describe_output(std::string& path);
Option describe_force(bool& force);
Option describe_view_size(std::int64_t& size);
Option describe_columns(std::int64_t& columns);
/// An option that names numbers per vertex (field_source.h); `help` says what for.
Option describe_field(const std::string& name, const std::string& help, std::string& source);

/// An option for a number of bytes; `help` says of what.
Option describe_bytes(const std::string& help, std::string& text);
/// "500KB", "1.5 MB", "2MiB", "300000": 1 or more. Throws Error(usage) with the option.
std::uint64_t parse_bytes(const std::string& option, const std::string& text);
/// Several with commas between them, falling.
std::vector<std::uint64_t> parse_byte_list(const std::string& option, const std::string& text);

/// "34,89": the numbers of an option's text, `least` to `most` of them. Throws Error(usage) with the option.
std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t least,
                                  std::size_t most);

/// What the options of written models need of each other.
void need_format(Arguments& arguments, const WriteOptions& options);
/// And those of views.
void need_views(Arguments& arguments, const ViewOptions& views);

}  // namespace fovea::cli
