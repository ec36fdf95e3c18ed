// Purpose: the three ways in which thesis §6.1.2 divides work on an image: forEach(x, y) is called
//          by an invocation for all pixels of its row (ROWS), of its column (COLUMNS), or for its
//          own pixel (PIXELS).
// Inputs:  size: of the image, px.
// Outputs: forEach()'s.
// Precision: integers.
#ifdef PIXELS
layout(local_size_x = 8, local_size_y = 8) in;
#else
layout(local_size_x = 64) in;
#endif
uniform ivec2 size;

void forEach(int x, int y);

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
#ifdef ROWS
  if (at.x >= size.y) return;
  for (int x = 0; x < size.x; ++x) forEach(x, at.x);
#endif
#ifdef COLUMNS
  if (at.x >= size.x) return;
  for (int y = 0; y < size.y; ++y) forEach(at.x, y);
#endif
#ifdef PIXELS
  if (at.x >= size.x || at.y >= size.y) return;
  forEach(at.x, at.y);
#endif
}
