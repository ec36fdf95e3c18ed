// Purpose: the mean of a stroke's direction now and what it was (thesis §5.4), in the doubled angle,
//          where directions have no sign.
// Inputs:  now, was: unit vectors; stays: the past's share, e^(-Δt / τ).
// Outputs: a unit vector, on the side that the past was on.
// Precision: highp.

// Taken continuously: to average (cos 2θ, sin 2θ) over many short steps lets the tangent of the angle
// between them shrink by `stays`. So the frame rate does not matter, and nothing turns by more than
// 1/(2τ); one weighted sum of two directions that are almost across would swing round at once.
vec2 heldDirection(vec2 now, vec2 was, float stays) {
  float along = dot(was, now);
  vec2 held = along * now + stays * (was - along * now);
  float squared = dot(held, held);
  return squared > 1e-12 ? held * inversesqrt(squared) : now;
}

// The same, of what was carried by the motion's Jacobian (column by column).
vec2 heldDirection(vec2 now, vec2 was, vec4 jacobian, float stays) {
  vec2 carried = jacobian.xy * was.x + jacobian.zw * was.y;
  float squared = dot(carried, carried);
  return squared > 1e-12 ? heldDirection(now, carried * inversesqrt(squared), stays) : now;
}
