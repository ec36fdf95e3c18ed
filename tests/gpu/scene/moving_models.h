#pragma once

#include "pipeline/scene/models/model.h"

namespace pleinair::scene {

/// Two parts that turn by themselves, one of them mirrored.
Model turningGears();
/// Two boxes that share a mesh, hung on animated nodes.
Model swingingBoxes();
/// A tube over two joints, one of which bends.
Model bendingArm();
/// A ball whose morph targets are animated, normals and all, on a node that moves too.
Model breathingBall();

}  // namespace pleinair::scene
