// Purpose: which strokes are traced, and by which of three programs: those on models, those of the
//          background that may meet labels of models or segments, and all others (stroke_lists.comp).
// Inputs, outputs: StrokeLists: three commands for glDispatchComputeIndirect (groups along x, y and
//          z), each with the length of its list; then a word for each slot: the slots of the first
//          list from the beginning on, after them those of the second, those of the third from the
//          end back.
// Precision: integers.
const uint kTraceGroup = 64u;  // the local size of stroke_trace.comp
const int kOnModels = 0;  // words of commands, as in stroke_set.cpp
const int kWithLabels = 4;
const int kMoversOnly = 8;
const int kListed = 12;

// Where a list has its entry `number`. `onModels`: the length of the first list.
int listedAt(int list, uint number, uint onModels, uint slots) {
  if (list == kMoversOnly) return kListed + int(slots - 1u - number);
  return kListed + int(number + (list == kWithLabels ? onModels : 0u));
}
