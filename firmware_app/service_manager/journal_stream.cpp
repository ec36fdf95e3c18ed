#include "firmware_app/service_manager/journal_stream.h"

#include <cstdlib>
#include <string>

#include <sys/stat.h>

namespace pleinair::app {

bool isJournalStream(int descriptor) {
  const char* const stream = std::getenv("JOURNAL_STREAM");
  struct stat file = {};
  if (stream == nullptr || fstat(descriptor, &file) != 0) return false;
  return stream == std::to_string(file.st_dev) + ":" + std::to_string(file.st_ino);
}

}  // namespace pleinair::app
