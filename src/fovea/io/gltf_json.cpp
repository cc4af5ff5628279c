#include "fovea/io/gltf_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/base/error.h"

namespace fovea::gltf {

namespace {

/// The message of the JSON library without its own "[json.exception...] " and position.
std::string plain_message(std::string message) {
  for (const char* end : {"] ", ": "}) {
    const std::size_t at = message.find(end);
    if (at != std::string::npos && (message[0] == '[' || message.starts_with("parse error"))) {
      message.erase(0, at + 2);
    }
  }
  return message;
}

/// Builds the tree from the parser's events. The library's own builder looks for a name's double at
/// every insertion, which is quadratic in an object's size and so an open door; nor does it know limits.
class TreeBuilder {
 public:
  TreeBuilder(const std::string& place, std::size_t offset, ByteBudget& budget)
      : place_(place), offset_(offset), budget_(budget) {}

  Json take() { return std::move(root_); }

  bool null() { return add(Json()); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(std::int64_t value) { return add(value); }
  bool number_unsigned(std::uint64_t value) { return add(value); }
  bool number_float(double value, const std::string&) { return add(value); }
  bool string(std::string& value) {
    budget_.charge(value.size(), 1, place_);
    return add(std::move(value));
  }
  bool binary(Json::binary_t&) { return false; }
  bool start_object(std::size_t) { return open(Json::object()); }
  bool start_array(std::size_t) { return open(Json::array()); }
  bool key(std::string& name) {
    budget_.charge(name.size(), 1, place_);
    open_.back()->get_ref<Json::object_t&>().emplace_back(std::move(name), Json());
    return true;
  }
  bool end_object() {
    refuse_doubles(open_.back()->get_ref<Json::object_t&>());
    open_.pop_back();
    return true;
  }
  bool end_array() {
    open_.pop_back();
    return true;
  }
  bool parse_error(std::size_t position, const std::string&, const Json::exception& e) {
    const std::size_t byte = offset_ + (position > 0 ? position - 1 : 0);
    throw Error(ErrorKind::format, "not valid JSON: " + plain_message(e.what()),
                fmt::format("{}: byte {}", place_, byte));
  }

 private:
  static constexpr std::uint64_t kBytesPerValue = 64;  // A tree node with its share of growth, roughly.

  Json* insert(Json&& value) {
    budget_.charge(1, kBytesPerValue, place_);
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    if (open_.back()->is_array()) {
      open_.back()->push_back(std::move(value));
      return &open_.back()->back();
    }
    Json& member = open_.back()->get_ref<Json::object_t&>().back().second;
    member = std::move(value);
    return &member;
  }

  bool add(Json&& value) {
    insert(std::move(value));
    return true;
  }

  bool open(Json&& value) {
    if (open_.size() >= static_cast<std::size_t>(kMaxJsonDepth)) {
      throw Error(ErrorKind::limit, fmt::format("JSON nested deeper than {} levels", kMaxJsonDepth), place_);
    }
    // The pointers stay valid: a container only grows when all that is inside it is closed.
    open_.push_back(insert(std::move(value)));
    return true;
  }

  void refuse_doubles(const Json::object_t& object) const {
    std::vector<std::string_view> names;
    names.reserve(object.size());
    for (const auto& member : object) names.push_back(member.first);
    std::sort(names.begin(), names.end());
    const auto twice = std::adjacent_find(names.begin(), names.end());
    if (twice != names.end()) {
      throw Error(ErrorKind::format, fmt::format("an object has the member {} twice", shown(*twice)), place_);
    }
  }

  const std::string& place_;
  std::size_t offset_;
  ByteBudget& budget_;
  Json root_;
  std::vector<Json*> open_;
};

bool fits(double number, std::int64_t low, std::int64_t high) {
  return number == std::floor(number) && number >= static_cast<double>(low) &&
         number <= static_cast<double>(high);
}

}  // namespace

Json parse_json(std::span<const std::byte> text, const std::string& place, std::size_t offset,
                ByteBudget& budget) {
  const auto* begin = reinterpret_cast<const char*>(text.data());
  TreeBuilder builder(place, offset, budget);
  Json::sax_parse(begin, begin + text.size(), &builder);
  return builder.take();
}

std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 80;
  const bool cut = text.size() > kMost;
  std::string out = Json(text.substr(0, kMost)).dump(-1, ' ', false, Json::error_handler_t::ignore);
  if (cut) out.insert(out.size() - 1, "…");
  return out;
}

std::string pointer_step(std::string_view name) {
  std::string out;
  for (const char c : name) {
    if (c == '~') {
      out += "~0";
    } else if (c == '/') {
      out += "~1";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out;
}

void JsonView::fail(const std::string& message) const { throw Error(ErrorKind::format, message, place()); }

void JsonView::expect(bool is_right, const char* what) const {
  if (!is_right) fail(fmt::format("expected {}, found {}", what, value_->type_name()));
}

std::optional<JsonView> JsonView::find(const char* name) const {
  expect(value_->is_object(), "an object");
  const auto it = value_->find(name);
  if (it == value_->end()) return std::nullopt;
  return JsonView(*it, pointer_ + "/" + pointer_step(name), *file_);
}

JsonView JsonView::at(const char* name) const {
  auto member = find(name);
  if (!member) fail(fmt::format("\"{}\" is missing", name));
  return *std::move(member);
}

std::optional<JsonView> JsonView::extension(const char* name) const {
  const auto extensions = find("extensions");
  return extensions ? extensions->find(name) : std::nullopt;
}

std::vector<JsonView> JsonView::elements() const {
  expect(value_->is_array(), "an array");
  std::vector<JsonView> views;
  views.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i) {
    views.emplace_back((*value_)[i], fmt::format("{}/{}", pointer_, i), *file_);
  }
  return views;
}

std::vector<JsonView> JsonView::elements(const char* name) const {
  const auto member = find(name);
  return member ? member->elements() : std::vector<JsonView>{};
}

std::vector<std::pair<std::string, JsonView>> JsonView::members() const {
  expect(value_->is_object(), "an object");
  std::vector<std::pair<std::string, JsonView>> views;
  for (const auto& [name, member] : value_->items()) {
    views.emplace_back(name, JsonView(member, pointer_ + "/" + pointer_step(name), *file_));
  }
  return views;
}

double JsonView::number() const {
  expect(value_->is_number(), "a number");
  return value_->get<double>();
}

bool JsonView::boolean() const {
  expect(value_->is_boolean(), "true or false");
  return value_->get<bool>();
}

const std::string& JsonView::text() const {
  expect(value_->is_string(), "a string");
  return value_->get_ref<const std::string&>();
}

std::int64_t JsonView::integer(std::int64_t low, std::int64_t high) const {
  expect(value_->is_number(), "an integer");
  // Through double: exact for all that glTF allows (up to 2⁵³), and no 64-bit value can wrap around.
  const double number = value_->get<double>();
  if (!fits(number, low, high)) {
    fail(fmt::format("expected an integer from {} to {}, found {}", low, high, value_->dump()));
  }
  return static_cast<std::int64_t>(number);
}

int JsonView::index(std::size_t count, const char* what) const {
  expect(value_->is_number(), "an index");
  const double number = value_->get<double>();
  const auto most = static_cast<std::int64_t>(std::min<std::size_t>(count, 0x7FFFFFFF)) - 1;
  if (!fits(number, 0, most)) {
    fail(fmt::format("{} is not among the {} {}", value_->dump(), count, what));
  }
  return static_cast<int>(number);
}

std::vector<double> JsonView::numbers() const {
  expect(value_->is_array(), "an array of numbers");
  std::vector<double> result(value_->size());
  copy_numbers(result.data(), result.size());
  return result;
}

void JsonView::copy_numbers(double* target, std::size_t count) const {
  if (!value_->is_array() || value_->size() != count)
    fail(fmt::format("expected an array of {} numbers", count));
  for (std::size_t i = 0; i < count; ++i) {
    if (!(*value_)[i].is_number()) fail(fmt::format("element {} is not a number", i));
    target[i] = (*value_)[i].get<double>();
  }
}

double JsonView::number(const char* name, double fallback) const {
  const auto member = find(name);
  return member ? member->number() : fallback;
}

bool JsonView::boolean(const char* name, bool fallback) const {
  const auto member = find(name);
  return member ? member->boolean() : fallback;
}

std::string JsonView::text(const char* name) const {
  const auto member = find(name);
  return member ? member->text() : std::string{};
}

std::int64_t JsonView::integer(const char* name, std::int64_t low, std::int64_t high,
                               std::int64_t fallback) const {
  const auto member = find(name);
  return member ? member->integer(low, high) : fallback;
}

std::uint64_t JsonView::size(const char* name, std::uint64_t fallback) const {
  const auto member = find(name);
  return member ? member->size() : fallback;
}

int JsonView::index(const char* name, std::size_t count, const char* what) const {
  const auto member = find(name);
  return member ? member->index(count, what) : -1;
}

std::vector<double> JsonView::numbers(const char* name) const {
  const auto member = find(name);
  return member ? member->numbers() : std::vector<double>{};
}

}  // namespace fovea::gltf
