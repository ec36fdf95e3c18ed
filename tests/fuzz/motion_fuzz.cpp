// Parses text as a motion.json, and queries its motion over several frames.
#include "pipeline/measure/input/motion_file.h"
#include "tests/fuzz/fuzz_target.h"

using namespace pleinair;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = measure::parseMotion(fuzz::asText(data, size), "motion.json");
  if (!file) {
    fuzz::expectOneLine(file.error().message());
    return 0;
  }
  constexpr std::uint64_t kFrames = 3;
  const auto motion = measure::motionOf(*file, {8, 6}, kFrames, "motion.json");
  if (!motion) {
    fuzz::expectOneLine(motion.error().message());
    return 0;
  }
  for (std::uint64_t to = 1; to < kFrames; ++to) {
    if (!(*motion)->between(0, to)) fuzz::fail("a motion that is not there");
  }
  return 0;
}
