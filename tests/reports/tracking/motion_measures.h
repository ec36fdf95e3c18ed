#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "hal/image.h"
#include "pipeline/tracking/motion/image_motion_estimator.h"

namespace pleinair::tracking {

/// Pictures of which the motion from each to the next is known.
struct MotionSequence {
  std::string name;
  std::vector<hal::Image> luma;
  /// From each frame to the next; empty where the picture does not follow one.
  std::vector<glm::dmat3> homographies;
  /// Where what frame `then` shows at a place is in the next, px; nothing where that is not known,
  /// or not seen there.
  std::function<std::optional<glm::dvec2>(std::size_t then, const glm::dvec2& px)> moved;
};

/// desk_6dof's plane: 1280×720, motion blur. Precondition: hasDeskSequence().
MotionSequence deskMotion(std::size_t mostFrames = 1000);
/// virtual_camera: 640×480. Precondition: hasVirtualCamera().
MotionSequence virtualCameraMotion(std::size_t mostFrames = 1000);
/// synth_layers: 640×360, layers that move apart by some 10 px a frame.
MotionSequence layersMotion();
bool hasLayers();

/// Errors in px of the frame, each with what was predicted of it.
struct Errors {
  std::vector<double> actual;
  std::vector<double> predicted;
  void add(double error, double prediction) {
    actual.push_back(error);
    predicted.push_back(prediction);
  }
  /// What the median of actual by predicted errors is, in parts of what it would be of normally
  /// distributed ones: 1 where predictions are right.
  double ratio() const;
  /// Of the part of the errors that is predicted to be smallest.
  Errors surest(double part) const;
};

/// What an estimator found, from the third frame on.
struct MotionResult {
  std::size_t frames = 0;
  std::size_t cuts = 0;
  std::size_t pictures = 0;  ///< frames with a homography
  double featuresPerFrame = 0.0;
  Errors features;
  Errors picture;  ///< RMS over the frame, where the true one is known
  Errors flow;     ///< forward
  std::vector<double> milliseconds;
};
MotionResult measureMotion(const MotionSequence& sequence, const ImageMotionOptions& options);

}  // namespace pleinair::tracking
