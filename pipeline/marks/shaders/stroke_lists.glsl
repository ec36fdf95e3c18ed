// Purpose: which strokes are traced, and by which of two programs: by one that knows models and
//          segments, or by a smaller one (stroke_lists.comp).
// Inputs, outputs: StrokeLists: two commands for glDispatchComputeIndirect (groups along x, y and z),
//          each with the length of its list; then a word for each slot: the slots of the first list
//          from the beginning on, those of the second from the end back.
// Precision: integers.
const uint kTraceGroup = 64u;  // the local size of stroke_trace.comp
const int kWithLabels = 0;  // words of commands, as in stroke_set.cpp
const int kMoversOnly = 4;
const int kListed = 8;

// Where a list has its entry `number`.
int listedAt(int list, uint number, uint slots) {
  return kListed + int(list == kWithLabels ? number : slots - 1u - number);
}
