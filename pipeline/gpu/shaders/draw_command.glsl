// Purpose: the command that glDrawArraysIndirect reads (gpu::kDrawCommandBytes).
// Inputs, outputs: counts of vertices and instances.
// Precision: integers.
struct DrawCommand {
  uint vertexCount;
  uint instanceCount;
  uint firstVertex;
  uint spare;
};
