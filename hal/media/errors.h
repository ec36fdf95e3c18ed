#pragma once

#include <string>

#include "hal/error.h"

namespace pleinair::hal::libav {

/// An Error with libav's code and text. Failures of reading and writing that come as errno values
/// (disk full, I/O error, no permission) keep their kind; `kind` is for everything else.
Error libavError(std::string subject, std::string problem, int code,
                 ErrorKind kind = ErrorKind::kInvalidInput, std::string remedy = {});

/// Keeps libav from printing, for the whole process; call before any other use of it. Its error
/// lines go to the LogCapture of the calling thread, if there is one, and are dropped otherwise.
void routeLog();

/// The first line that libav logged as an error on this thread while this lives. One at a time on a
/// thread; the inner one hides the outer.
class LogCapture {
 public:
  LogCapture();
  ~LogCapture();
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;

  /// Printable text without a newline; empty if there was no error.
  const std::string& firstError() const { return firstError_; }
  void clear() { firstError_.clear(); }

 private:
  friend struct LogRouter;
  LogCapture* outer_;
  std::string firstError_;
};

}  // namespace pleinair::hal::libav
