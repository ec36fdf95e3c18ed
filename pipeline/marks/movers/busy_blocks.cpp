#include "pipeline/marks/movers/busy_blocks.h"

#include <cstdint>

namespace pleinair::marks {
namespace {

/// The most groups of the program that the command may have.
glm::ivec2 mostGroups(const gpu::Program& program, BlockCommand command, glm::ivec2 grid) {
  const int blocks = grid.x * grid.y;
  switch (command) {
    case BlockCommand::kNear:
    case BlockCommand::kBusy:
      return {blocks, 1};
    case BlockCommand::kCount:
      return program.groupsFor({blocks, 1});
    case BlockCommand::kParts:
      return {1, 1};
    case BlockCommand::kGround:
    case BlockCommand::kMotion:
      break;
  }
  return program.groupsFor(grid);
}

}  // namespace

gpu::Program& BusyBlocks::bind(gpu::Program& program) const {
  return program.storage("BusyBlocks", *words).set("grid", grid);
}

void BusyBlocks::dispatch(gpu::Program& program, GLbitfield barriers, BlockCommand command) const {
  const std::size_t offsetBytes = static_cast<std::size_t>(command) * sizeof(std::uint32_t);
  bind(program).dispatchListed(*words, offsetBytes, mostGroups(program, command, grid), barriers);
}

}  // namespace pleinair::marks
