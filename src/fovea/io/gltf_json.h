#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/io/byte_budget.h"

// Private to io: reading the JSON of a glTF file.

namespace fovea::gltf {

/// Keeps members in the order in which they were read.
using Json = nlohmann::ordered_json;

/// Deepest nesting of objects and arrays that is read: far beyond any real file, far below what
/// recursion over the tree could do to the stack.
inline constexpr int kMaxJsonDepth = 128;

/// Parses UTF-8 JSON. `place` names the file, `offset` is where the text begins in it. The memory that
/// the tree takes is charged as it grows. Throws Error(format) with the byte offset in the file for
/// anything that is not JSON and for a name that an object has twice, Error(limit) beyond kMaxJsonDepth.
/// O(n log n), also for huge objects.
Json parse_json(std::span<const std::byte> text, const std::string& place, std::size_t offset,
                ByteBudget& budget);

/// `text` in quotes, control characters escaped and cut to a readable length: file content in messages.
std::string shown(std::string_view text);

/// `name` as one step of a JSON pointer ("/" and "~" escaped, control characters made visible).
std::string pointer_step(std::string_view name);

/// A JSON value and where it stands. Every access checks its type: a fault is Error(format) whose place
/// is the file and the JSON pointer. Refers to the value and to the file's name; cheap to copy.
class JsonView {
 public:
  JsonView(const Json& value, std::string pointer, const std::string& file)
      : value_(&value), file_(&file), pointer_(std::move(pointer)) {}

  const Json& raw() const { return *value_; }
  const std::string& pointer() const { return pointer_; }
  /// File and JSON pointer, as errors and diagnostics give it.
  std::string place() const { return pointer_.empty() ? *file_ : *file_ + ": " + pointer_; }
  [[noreturn]] void fail(const std::string& message) const;

  /// A member of this object, or none. A value that is no object is a fault.
  std::optional<JsonView> find(const char* name) const;
  /// As `find`, but its absence is a fault.
  JsonView at(const char* name) const;
  bool has(const char* name) const { return find(name).has_value(); }
  /// A view of `value` as standing at a JSON pointer below this one.
  JsonView inner(const Json& value, const std::string& pointer) const {
    return {value, pointer_ + pointer, *file_};
  }
  /// The extension `name` of this object, or none.
  std::optional<JsonView> extension(const char* name) const;
  /// The elements of this array.
  std::vector<JsonView> elements() const;
  /// The elements of the array that is the member `name`; none if it is absent.
  std::vector<JsonView> elements(const char* name) const;
  /// Names and values of the members of this object, in the order of the file.
  std::vector<std::pair<std::string, JsonView>> members() const;

  double number() const;
  bool boolean() const;
  const std::string& text() const;
  /// An integer in [low, high]; written as 5 or 5.0.
  std::int64_t integer(std::int64_t low, std::int64_t high) const;
  /// A size or offset: 0 … 2⁵³.
  std::uint64_t size() const { return static_cast<std::uint64_t>(integer(0, std::int64_t{1} << 53)); }
  /// An index into an array of `count` elements called `what`.
  int index(std::size_t count, const char* what) const;
  /// The numbers of this array.
  std::vector<double> numbers() const;

  // The same for a member that may be absent.
  double number(const char* name, double fallback) const;
  bool boolean(const char* name, bool fallback) const;
  std::string text(const char* name) const;
  std::int64_t integer(const char* name, std::int64_t low, std::int64_t high, std::int64_t fallback) const;
  std::uint64_t size(const char* name, std::uint64_t fallback) const;
  int index(const char* name, std::size_t count, const char* what) const;  ///< -1 if absent.
  std::vector<double> numbers(const char* name) const;                     ///< Empty if absent.
  /// Exactly N numbers into `target`; untouched if absent.
  template <class Target>
  void numbers_into(const char* name, Target& target) const {
    if (const auto member = find(name)) member->copy_numbers(target.data(), target.size());
  }

 private:
  void copy_numbers(double* target, std::size_t count) const;
  void expect(bool is_right, const char* what) const;

  const Json* value_;
  const std::string* file_;
  std::string pointer_;
};

}  // namespace fovea::gltf
