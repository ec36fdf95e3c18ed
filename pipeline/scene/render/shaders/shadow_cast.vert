// Purpose: projects a model along the light onto a plane: position of its shadow, and height of the
//          caster.
// Inputs:  position in the model's frame; mapFromModel (scene::ShadowPlan).
// Outputs: the position in the shadow map; height, 0 … 1 of the map's.
// Precision: highp.
uniform mat4 mapFromModel;

layout(location = 0) in vec3 position;

out float height;

void main() {
  gl_Position = mapFromModel * vec4(position, 1.0);
  height = 0.5 * gl_Position.z + 0.5;
}
