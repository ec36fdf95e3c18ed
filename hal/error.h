#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace pleinair::hal {

/// The kind of a failure. Callers decide by it, and the exit status follows from it.
enum class ErrorKind {
  kInvalidArgument,  ///< the caller asked for something that is not possible at all
  kInvalidInput,     ///< a file or stream is broken or of an unknown kind
  kUnsupported,      ///< valid, but not supported by this build or device
  kNotFound,
  kPermissionDenied,
  kNoSpace,  ///< disk or quota full
  kBusy,
  kTimeout,
  kDeviceLost,
  kCancelled,  ///< the caller asked for the end of it
  kIo,
  kInternal,
};

/// The numbering that `Error::code` belongs to.
enum class ErrorDomain { kNone, kErrno, kLibav, kEgl, kGl };

/// A failure of the world, as a value. It reads as one line: the place, the problem, the remedy.
struct Error {
  ErrorKind kind = ErrorKind::kInternal;
  std::string subject;  ///< the device, file or argument: "out/movie.mp4"
  std::string problem;  ///< the operation and what went wrong: "cannot write: disk full"
  std::string remedy;   ///< the next step, or empty: "free space or choose another --output"
  ErrorDomain domain = ErrorDomain::kNone;
  int code = 0;  ///< in the numbering of `domain`; 0: none

  /// "subject: problem; remedy", without a newline.
  std::string message() const;
};

template <class T>
using Result = tl::expected<T, Error>;

/// An Error with errno's kind, domain and text. `problem` names the operation: "cannot open".
Error errnoError(std::string subject, std::string problem, int errnoValue, std::string remedy = {});

/// Yes, no, or an error: the answer of a call that can fail. It converts to no bool, because an
/// `if` on a Result<bool> would ask for the error where its reader takes it for the answer.
class [[nodiscard]] Answer {
 public:
  Answer(bool isYes) : answer_(isYes) {}
  Answer(tl::unexpected<Error> error) : answer_(std::move(error)) {}

  bool hasError() const { return !answer_.has_value(); }
  /// Precondition: hasError().
  const Error& error() const { return answer_.error(); }
  /// False also where there is an error.
  bool isYes() const { return answer_.value_or(false); }

 private:
  Result<bool> answer_;
};

/// A failure of the world at start-up, printed as one line and never as a stack trace. While
/// running, failures are values (`Result`), not exceptions.
class Failure : public std::runtime_error {
 public:
  explicit Failure(Error error);
  const Error& error() const { return error_; }

 private:
  Error error_;
};

/// Gives the value, or throws its error as a Failure. For start-up code only.
template <class T>
T orThrow(Result<T> result) {
  if (!result) throw Failure(std::move(result.error()));
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

/// Whether the answer is yes, or a Failure thrown from its error. For start-up code only.
inline bool orThrow(const Answer& answer) {
  if (answer.hasError()) throw Failure(answer.error());
  return answer.isYes();
}

}  // namespace pleinair::hal
