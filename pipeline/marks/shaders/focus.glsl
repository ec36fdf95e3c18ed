// Purpose: how finely a place is painted: the target of density there (marks::FocusField).
// Inputs:  focusPlaces: a disc in each column: its centre, radius and falloff, px of the full image;
//          falloff 0: none. focusStrength: in [0, 1]; 0: no focus.
// Outputs: in [0, 1].
// Precision: highp.
uniform mat4 focusPlaces;
uniform float focusStrength;

// 1 in a focus, 0 far from all.
float focusAt(vec2 px) {
  float most = 0.0;
  for (int i = 0; i < 4; ++i) {
    vec4 place = focusPlaces[i];
    if (place.w <= 0.0) continue;
    most = max(most, 1.0 - smoothstep(place.z, place.z + place.w, distance(px, place.xy)));
  }
  return most;
}

// 1 where the finest strokes are allowed, 0 where only the broadest are.
float finenessAt(vec2 px) {
  return focusStrength > 0.0 ? 1.0 - focusStrength * (1.0 - focusAt(px)) : 1.0;
}

// The part of a layer's strokes that is painted, where layers count from the broadest, 0, to the
// finest: the finest vanish first.
float layerShare(float fineness, float layer, float layers) {
  return clamp(1.0 + fineness * (layers - 1.0) - layer, 0.0, 1.0);
}
