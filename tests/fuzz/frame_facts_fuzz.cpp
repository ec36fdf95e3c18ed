// Parses what a recording says of a frame: what was read can be written and read again.
#include "hal/captures/frame_facts.h"
#include "tests/fuzz/fuzz_target.h"

using namespace pleinair;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto facts = hal::captures::parseFacts(fuzz::asText(data, size));
  if (facts && hal::captures::parseFacts(textOf(*facts)) != facts) {
    fuzz::fail("facts that are not read as they are written");
  }
  return 0;
}
