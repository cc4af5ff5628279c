#include "fovea/base/error.h"

#include <utility>

namespace fovea {

Error::Error(ErrorKind kind, std::string message, std::string place, std::string hint)
    : std::runtime_error(place.empty() ? message : place + ": " + message),
      kind_(kind),
      message_(std::move(message)),
      place_(std::move(place)),
      hint_(std::move(hint)) {}

Error Error::within(const std::string& outer) const {
  return Error(kind_, message_, place_.empty() ? outer : outer + ": " + place_, hint_);
}

int exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::internal: return 1;
    case ErrorKind::usage: return 2;
    case ErrorKind::input: return 3;
    case ErrorKind::format: return 4;
    case ErrorKind::unsupported: return 5;
    case ErrorKind::limit: return 6;
    case ErrorKind::output: return 7;
    case ErrorKind::cancelled: return 130;
  }
  return 1;
}

const char* to_string(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::internal: return "internal";
    case ErrorKind::usage: return "usage";
    case ErrorKind::input: return "input";
    case ErrorKind::format: return "format";
    case ErrorKind::unsupported: return "unsupported";
    case ErrorKind::limit: return "limit";
    case ErrorKind::output: return "output";
    case ErrorKind::cancelled: return "cancelled";
  }
  return "internal";
}

}  // namespace fovea
