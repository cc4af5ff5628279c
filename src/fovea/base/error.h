#pragma once

#include <stdexcept>
#include <string>

namespace fovea {

/// What went wrong, in the terms of whoever has to act on it. Each kind has its own exit code.
enum class ErrorKind {
  internal,     ///< A bug of ours: an invariant that the code promised does not hold.
  usage,        ///< An option or argument that is wrong whatever the files hold.
  input,        ///< A file cannot be found or read.
  format,       ///< A file is damaged, breaks the rules of its format or holds bad values.
  unsupported,  ///< A file is sound but needs what Fovea cannot do, or lacks what is asked of it.
  limit,        ///< The data exceeds a limit on size that protects the machine.
  output,       ///< A file cannot be written.
  cancelled,    ///< The caller asked to stop and no partial result exists.
};

/// The one exception of the library.
///
/// `message` says what is wrong, `place` where (file, then a JSON pointer, line or byte offset),
/// `hint` what to do about it. `what()` is "place: message".
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, std::string message, std::string place = {}, std::string hint = {});

  ErrorKind kind() const { return kind_; }
  const std::string& message() const { return message_; }
  const std::string& place() const { return place_; }
  const std::string& hint() const { return hint_; }

  /// The same error with `outer` put before its place: "model.glb: /meshes/0".
  Error within(const std::string& outer) const;

 private:
  ErrorKind kind_;
  std::string message_;
  std::string place_;
  std::string hint_;
};

/// Exit code of the command line for an error kind: internal 1, usage 2, input 3, format 4,
/// unsupported 5, limit 6, output 7, cancelled 130. (0 is success, 8 "target not reached".)
int exit_code(ErrorKind kind);

/// Short name of a kind for machine-readable reports: "format", "limit", ...
const char* to_string(ErrorKind kind);

}  // namespace fovea
