// Purpose: the mean of a stroke's current and previous direction (thesis §5.4), in the doubled
//          angle, in which directions have no sign.
// Inputs:  now, was: unit vectors; stays: the past's share, e^(-Δt / τ).
// Outputs: a unit vector, on the past's side.
// Precision: highp.

// The continuous form of the mean: averaging (cos 2θ, sin 2θ) over many short steps shrinks the
// tangent of the angle between the two by `stays`. So the result does not depend on the frame rate,
// and no direction turns by more than 1/(2τ). One weighted sum of two directions that are almost
// perpendicular would swing round at once.
vec2 heldDirection(vec2 now, vec2 was, float stays) {
  float along = dot(was, now);
  vec2 held = along * now + stays * (was - along * now);
  float squared = dot(held, held);
  return squared > 1e-12 ? held * inversesqrt(squared) : now;
}

// The same for a direction that the motion's Jacobian (column-major) has moved.
vec2 heldDirection(vec2 now, vec2 was, vec4 jacobian, float stays) {
  vec2 carried = jacobian.xy * was.x + jacobian.zw * was.y;
  float squared = dot(carried, carried);
  return squared > 1e-12 ? heldDirection(now, carried * inversesqrt(squared), stays) : now;
}
