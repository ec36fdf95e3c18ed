#pragma once

#include <string>

#include "hal/error.h"

namespace pleinair::hal::libav {

/// An Error with libav's code and text. Read and write failures that arrive as errno values (disk
/// full, I/O error, no permission) keep their kind; all others get `kind`.
Error libavError(std::string subject, std::string problem, int code,
                 ErrorKind kind = ErrorKind::kInvalidInput, std::string remedy = {});

/// Redirects libav's log for the whole process; call before any other use of libav. Its error lines
/// go to the LogCapture of the calling thread, if there is one; all other lines are dropped.
void redirectLog();

/// Captures the first line that libav logs as an error on this thread while this object lives. If
/// captures are nested on a thread, the inner one receives the lines.
class LogCapture {
 public:
  LogCapture();
  ~LogCapture();
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;

  /// Printable text without a newline; empty without an error.
  const std::string& firstError() const { return firstError_; }
  void clear() { firstError_.clear(); }

 private:
  friend struct LogRouter;
  LogCapture* outer_;
  std::string firstError_;
};

}  // namespace pleinair::hal::libav
