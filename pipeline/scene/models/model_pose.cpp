#include "pipeline/scene/models/model_pose.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <span>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "pipeline/scene/models/mesh.h"
#include "pipeline/scene/models/rig.h"

namespace pleinair::scene {
namespace {

using ChannelValue = std::array<double, kMaxMorphTargets>;

std::span<const double> sampled(const Channel& channel, double seconds, ChannelValue& memory) {
  const std::span<double> value = std::span(memory).first(channel.width);
  valueAt(channel, seconds, value);
  return value;
}

void movePlace(const Channel& channel, double seconds, NodePlace& place) {
  ChannelValue memory;
  const std::span<const double> value = sampled(channel, seconds, memory);
  switch (channel.property) {
    case AnimatedProperty::kTranslation:
      place.translation = {value[0], value[1], value[2]};
      return;
    case AnimatedProperty::kRotation:
      place.rotation = glm::dquat(value[3], value[0], value[1], value[2]);
      return;
    case AnimatedProperty::kScale:
      place.scale = {value[0], value[1], value[2]};
      return;
    case AnimatedProperty::kWeights:
      return;
  }
}

void animate(const Clip& clip, double seconds, ModelPose& pose) {
  for (std::size_t i = 0; i < clip.channels.size(); ++i) {
    const Channel& channel = clip.channels[i];
    if (channel.property == AnimatedProperty::kWeights) {
      pose.weightsChannels[channel.node] = i;
    } else {
      movePlace(channel, seconds, pose.places[channel.node]);
    }
  }
}

void poseNodes(const Rig& rig, const std::optional<ClipMoment>& moment, ModelPose& pose) {
  const std::size_t count = rig.nodes.size();
  pose.places.clear();
  for (const RigNode& node : rig.nodes) pose.places.push_back(node.rest);
  pose.weightsChannels.assign(count, ModelPose::kNoChannel);
  if (moment) animate(rig.clips[moment->clip], moment->seconds, pose);
  pose.rootFromNode.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const RigNode& node = rig.nodes[i];
    const glm::dmat4 rootFromParent =
        node.parent ? pose.rootFromNode[*node.parent] : glm::dmat4(1.0);
    const glm::dmat4 rootFromNode =
        rootFromParent *
        (node.parentFromNode ? *node.parentFromNode : parentFromNode(pose.places[i]));
    pose.rootFromNode.push_back(isBounded(rootFromNode) ? rootFromNode : rootFromParent);
  }
}

void addMatrices(const Model& model, const ModelPart& part, hal::Duration turning,
                 ModelPose& pose) {
  const Rig& rig = model.rig;
  if (part.skin) {
    const Skin& skin = rig.skins[*part.skin];
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
      pose.matrices.push_back(rig.modelFromRoot * pose.rootFromNode[skin.joints[i]] *
                              skin.jointFromMesh[i]);
    }
  } else if (part.node) {
    const glm::dmat4 modelFromNode = rig.modelFromRoot * pose.rootFromNode[*part.node];
    pose.matrices.push_back(
        part.radiansPerSecond == 0.0 ? modelFromNode : modelFromNode * turnedAfter(part, turning));
  } else {
    pose.matrices.push_back(modelFromPart(part, turning));
  }
}

void addWeights(const Rig& rig, const ModelPart& part, const std::optional<ClipMoment>& moment,
                ModelPose& pose) {
  pose.weights.resize(part.firstWeight + part.weightCount, 0.0F);
  if (!part.node || part.weightCount == 0) return;
  const auto weights = std::span(pose.weights).last(part.weightCount);
  const auto set = [&](const auto& values) {
    for (std::size_t i = 0; i < std::min(weights.size(), values.size()); ++i) {
      weights[i] = std::clamp(static_cast<float>(values[i]), -kMaxMorphWeight, kMaxMorphWeight);
    }
  };
  const std::size_t channel = pose.weightsChannels[*part.node];
  if (channel == ModelPose::kNoChannel) {
    set(rig.nodes[*part.node].weights);
  } else {
    ChannelValue memory;
    set(sampled(rig.clips[moment->clip].channels[channel], moment->seconds, memory));
  }
}

/// The weighted mean of the matrices of a vertex's joints.
glm::dmat4 blended(const JointWeights& held, std::span<const glm::dmat4> matrices) {
  glm::dmat4 sum(0.0);
  for (std::size_t i = 0; i < held.joints.size(); ++i) {
    if (held.weights[i] > 0.0F) {
      sum += static_cast<double>(held.weights[i]) * matrices[held.joints[i]];
    }
  }
  return sum;
}

}  // namespace

void poseModel(const Model& model, const std::optional<ClipMoment>& moment, hal::Duration turning,
               ModelPose& pose) {
  assert(!moment || moment->clip < model.rig.clips.size());
  poseNodes(model.rig, moment, pose);
  pose.matrices.clear();
  pose.weights.clear();
  for (const ModelPart& part : model.parts) {
    addMatrices(model, part, turning, pose);
    addWeights(model.rig, part, moment, pose);
  }
}

MeshVertex posedVertex(const Model& model, const ModelPart& part, std::size_t surface,
                       std::size_t vertex, const ModelPose& pose) {
  const Mesh& mesh = model.surfaces[part.firstSurface + surface].mesh;
  MeshVertex posed = mesh.vertices[vertex];
  glm::dvec3 position(posed.position);
  glm::dvec3 normal(posed.normal);
  for (std::size_t i = 0; i < mesh.morphTargets.size(); ++i) {
    const auto weight = static_cast<double>(pose.weights[part.firstWeight + i]);
    const MorphTarget& target = mesh.morphTargets[i];
    position += weight * glm::dvec3(target.positions[vertex]);
    if (!target.normals.empty()) normal += weight * glm::dvec3(target.normals[vertex]);
  }
  const auto matrices = std::span(pose.matrices).subspan(part.firstMatrix, part.matrixCount);
  const glm::dmat4 modelFromMesh =
      part.skin ? blended(mesh.joints[vertex], matrices) : matrices.front();
  posed.position = glm::vec3(modelFromMesh * glm::dvec4(position, 1.0));
  const glm::dvec3 turned = normalsAlong(glm::dmat3(modelFromMesh)) * normal;
  const double length = glm::length(turned);
  // Unchanged if the transform squashes it.
  if (length > 0.0) posed.normal = glm::vec3(turned / length);
  return posed;
}

}  // namespace pleinair::scene
