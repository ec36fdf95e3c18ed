#pragma once

#include "pipeline/scene/models/model.h"

namespace pleinair::scene {

/// Two rotating parts, one of them mirrored.
Model turningGears();
/// Two boxes that share a mesh, on animated nodes.
Model swingingBoxes();
/// A tube with two joints, one of which bends.
Model bendingArm();
/// A ball with animated morph targets, including normals, on a moving node.
Model breathingBall();

}  // namespace pleinair::scene
