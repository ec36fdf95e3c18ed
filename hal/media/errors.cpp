#include "hal/media/errors.h"

#include <array>
#include <cerrno>
#include <cstdarg>
#include <mutex>
#include <string_view>
#include <utility>

#include "hal/media/handles.h"

namespace pleinair::hal::libav {

/// Receives libav's log lines.
struct LogRouter {
  static thread_local LogCapture* current;

  static void take(void* context, int level, const char* format, std::va_list arguments) {
    if (level > AV_LOG_ERROR || current == nullptr || !current->firstError_.empty()) return;
    std::array<char, 256> line{};
    int printPrefix = 0;
    av_log_format_line2(context, level, format, arguments, line.data(),
                        static_cast<int>(line.size()), &printPrefix);
    if (std::string_view(line.data()).starts_with("Not yet implemented")) {
      current->firstError_ = "unknown coding";
      return;
    }
    for (const char c : line) {
      if (c == '\0' || c == '\n') break;
      // Escapes control characters: the text of a broken file must not control a terminal.
      current->firstError_ += c >= ' ' && c <= '~' ? c : '?';
    }
  }
};

thread_local LogCapture* LogRouter::current = nullptr;

LogCapture::LogCapture() : outer_(LogRouter::current) {
  LogRouter::current = this;
}

LogCapture::~LogCapture() {
  LogRouter::current = outer_;
}

void redirectLog() {
  static std::once_flag once;
  std::call_once(once, [] { av_log_set_callback(&LogRouter::take); });
}

Error libavError(std::string subject, std::string problem, int code, ErrorKind kind,
                 std::string remedy) {
  // Only the errno values from this module's own readers and writers describe the world. With any
  // other value libav rejects the data.
  switch (AVUNERROR(code)) {
    case EIO:
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
    case EACCES:
    case EPERM:
      return errnoError(std::move(subject), std::move(problem), AVUNERROR(code), std::move(remedy));
    default:
      break;
  }
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(code, text.data(), text.size());
  return Error{.kind = kind,
               .subject = std::move(subject),
               .problem = std::move(problem) + ": " + text.data(),
               .remedy = std::move(remedy),
               .domain = ErrorDomain::kLibav,
               .code = code};
}

}  // namespace pleinair::hal::libav
