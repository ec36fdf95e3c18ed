#include "firmware_app/cli/standard_streams.h"

#include <csignal>

#include <fcntl.h>
#include <unistd.h>

namespace pleinair::app {

void prepareStandardStreams() {
  std::signal(SIGPIPE, SIG_IGN);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) >= 0) continue;
    // open() takes the lowest free number, which is `stream`. Standard output stays unwritable, so
    // that a listing which nobody receives is still an error.
    const int mode = stream == STDERR_FILENO ? O_RDWR : O_RDONLY;
    if (open("/dev/null", mode) < 0) return;
  }
}

void writeText(std::FILE* stream, std::string_view text) {
  // fmt::print() would throw.
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stream));
}

}  // namespace pleinair::app
