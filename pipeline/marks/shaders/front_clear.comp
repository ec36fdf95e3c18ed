// Purpose: no mover before models (marks::FrontMovers), for front_movers.comp to write to where there are.
// Inputs:  none.
// Outputs: front RGBA16F: 0. One invocation per cell.
// Precision: none is needed.
layout(local_size_x = 16, local_size_y = 4) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D front;

void main() {
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (all(lessThan(cell, imageSize(front)))) imageStore(front, cell, vec4(0.0));
}
