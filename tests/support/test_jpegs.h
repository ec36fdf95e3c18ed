#pragma once

#include <cstdint>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "hal/pixel_format.h"

namespace pleinair::support {

/// The size of every upright JPEG in the fuzzing corpus.
inline constexpr hal::FrameSize kTestJpegSize{21, 14};

/// A JPEG of tests/fuzz/corpus/picture; all show the same image: "j420.jpg", "j422.jpg" …
inline std::vector<std::uint8_t> testJpeg(const std::string& name) {
  std::ifstream file(std::string(PLEINAIR_TESTS_DIR) + "/fuzz/corpus/picture/" + name,
                     std::ios::binary);
  if (!file) throw std::runtime_error("no " + name + " in the corpus");
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace pleinair::support
