// Commands to a procedure, as the status server takes them: what is read is read the same when it
// is written again.
#include "pipeline/procedure/step_command.h"
#include "tests/fuzz/fuzz_target.h"

using namespace pleinair;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto command = procedure::parseStepCommand(fuzz::asText(data, size));
  if (!command) {
    fuzz::expectOneLine(command.error().message());
    return 0;
  }
  const auto again = procedure::parseStepCommand(textOf(*command));
  if (!again || !(*again == *command)) fuzz::fail("another command: " + textOf(*command));
  return 0;
}
