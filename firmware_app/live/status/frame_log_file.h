#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "hal/error.h"
#include "pipeline/runtime/frame_log.h"

namespace pleinair::app {

/// A table of what became of each frame at each output, for plots of the time that frames were
/// shown at against the time that they were due: text, one row a frame, with commas between the
/// columns, which the first row names. Rows stand in it within a second. One thread.
class FrameLogFile {
 public:
  /// Replaces a file. `outputs`: the names behind FrameRecord::output. Throws hal::Failure.
  FrameLogFile(const std::filesystem::path& path, std::vector<std::string> outputs);

  /// For runtime::OutputStageOptions::log.
  runtime::FrameLog& log() { return log_; }
  /// Writes the records since the last call, several times a second. Errors: kIo, once; nothing is
  /// written after it.
  hal::Result<void> update();

 private:
  std::string path_;
  std::vector<std::string> outputs_;
  std::ofstream file_;
  runtime::FrameLog log_;
  std::vector<runtime::FrameRecord> records_;  ///< a member so that its memory is reused
};

}  // namespace pleinair::app
