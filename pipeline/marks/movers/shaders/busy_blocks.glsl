// Purpose: the blocks of cells in which anything differs from the background or moves, which the
//          costly passes of marks::MotionLayers are dispatched for (motion_layers_near_mark.comp,
//          motion_layers_busy_mark.comp); all others remain background.
// Inputs:  grid: blocks; layer_blocks.glsl's.
// Outputs: functions. A program that is dispatched by a command returns beyond it, since not every
//          driver is given the command (gpu::Program::dispatchListed). The buffer: commands for glDispatchComputeIndirect (x, y, z), then three words
//          a block: its flags, and two lists of blocks.
// Precision: integers.
#include "pipeline/marks/movers/shaders/layer_blocks.glsl"
const uint kMayBeMover = 1u;  // flags: a cell may be a mover's, if one is near
const uint kIsNear = 2u;      // a cell moves, or was a mover's
const uint kIsBusy = 4u;      // a cell is other content, was a mover's, or may be of one in place
const uint kIsOfFirst = 8u;   // the block is in the first list
const uint kIsOfSecond = 16u;

// Words of commands, as in marks::BlockCommand.
const int kNearCommand = 0;    // a group for each block of the first list
const int kBusyCommand = 3;    // a group for each block of the second list
const int kCountCommand = 6;   // an invocation for each block of the second list
const int kPartsCommand = 9;   // one group, if there is a busy block
const int kGroundCommand = 12;  // an invocation for each block of the picture, if there is a busy one
const int kMotionCommand = 15;  // the same, or if there was one in the previous frame
const int kWasBusy = 18;       // the blocks that were busy in the previous frame
const int kHighestMover = 19;  // two, in turns: the highest number of a mover that has a motion
const int kBusyWords = 21;

layout(std430, binding = 1) buffer BusyBlocks { uint busyWords[]; };
uniform ivec2 grid;

// Whether the invocation's group is beyond those of a command.
bool isBeyond(int command) { return gl_WorkGroupID.x >= busyWords[command]; }
int blockCount() { return grid.x * grid.y; }
int flagsAt(ivec2 block) { return kBusyWords + block.y * grid.x + block.x; }
int nearAt(int index) { return kBusyWords + blockCount() + index; }
int busyAt(int index) { return kBusyWords + 2 * blockCount() + index; }
ivec2 blockOf(uint index) { return ivec2(int(index) % grid.x, int(index) / grid.x); }
