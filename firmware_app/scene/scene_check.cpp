#include "firmware_app/scene/scene_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace pleinair::app {
namespace {

const cv::Scalar kTagColour(255, 210, 0);
const cv::Scalar kForeignTagColour(150, 150, 150);
const cv::Scalar kBoxColour(0, 220, 220);
constexpr double kWorldAxisMetres = 0.1;

std::string attachmentOf(const scene::SceneModel& model) {
  return model.tagId ? fmt::format("tag {}", *model.tagId) : "the world";
}

/// Lines between points of one frame, as the camera sees them.
class Overlay {
 public:
  Overlay(hal::Image& picture, const tracking::CameraModel& camera)
      : matrix_(picture.size().height, picture.size().width, CV_8UC3, picture.plane(0).data()),
        camera_(camera),
        thickness_(std::max(1, picture.size().width / 640)) {}

  void line(const glm::dmat4& cameraFromFrame, glm::dvec3 from, glm::dvec3 to,
            const cv::Scalar& colour) {
    const auto a = projected(cameraFromFrame, from);
    const auto b = projected(cameraFromFrame, to);
    if (a && b) cv::line(matrix_, *a, *b, colour, thickness_, cv::LINE_AA);
  }
  void axes(const glm::dmat4& cameraFromFrame, double length) {
    line(cameraFromFrame, {}, {length, 0, 0}, {230, 30, 30});
    line(cameraFromFrame, {}, {0, length, 0}, {30, 200, 30});
    line(cameraFromFrame, {}, {0, 0, length}, {40, 80, 255});
  }
  void box(const glm::dmat4& cameraFromFrame, const AxisBox& box) {
    const auto corner = [&](unsigned bits) {
      return glm::dvec3((bits & 1U) != 0 ? box.most.x : box.least.x,
                        (bits & 2U) != 0 ? box.most.y : box.least.y,
                        (bits & 4U) != 0 ? box.most.z : box.least.z);
    };
    for (unsigned from = 0; from < 8; ++from) {
      for (const unsigned bit : {1U, 2U, 4U}) {
        if ((from & bit) == 0) line(cameraFromFrame, corner(from), corner(from | bit), kBoxColour);
      }
    }
  }
  void tag(const tracking::TrackedTag& tag, bool isOfScene) {
    const cv::Scalar colour = isOfScene ? kTagColour : kForeignTagColour;
    for (std::size_t i = 0; i < tag.corners.size(); ++i) {
      const glm::dvec2 a = tag.corners.at(i);
      const glm::dvec2 b = tag.corners.at((i + 1) % tag.corners.size());
      cv::line(matrix_, cv::Point2d(a.x, a.y), cv::Point2d(b.x, b.y), colour, thickness_,
               cv::LINE_AA);
    }
    const cv::Point2d at(tag.corners[3].x, tag.corners[3].y - 4);
    cv::putText(matrix_, std::to_string(tag.id), at, cv::FONT_HERSHEY_SIMPLEX, 0.6 * thickness_,
                colour, thickness_, cv::LINE_AA);
  }

 private:
  std::optional<cv::Point2d> projected(const glm::dmat4& cameraFromFrame, glm::dvec3 point) const {
    constexpr double kNearest = 0.01;
    constexpr double kFarthestPx = 20000;  // OpenCV's drawing is in fixed point
    const glm::dvec3 seen(cameraFromFrame * glm::dvec4(point, 1.0));
    if (seen.z < kNearest) return std::nullopt;
    const glm::dvec2 px = camera_.project(seen);
    if (!(std::abs(px.x) < kFarthestPx && std::abs(px.y) < kFarthestPx)) return std::nullopt;
    return cv::Point2d(px.x, px.y);
  }

  cv::Mat matrix_;
  const tracking::CameraModel& camera_;
  int thickness_;
};

}  // namespace

AxisBox attachedBox(const scene::SceneModel& model) {
  std::optional<AxisBox> box;
  for (const scene::ModelPart& part : model.model->parts) {
    const glm::dmat4 attachFromPart = model.attachFromModel * part.modelFromPart;
    for (std::size_t i = 0; i < part.surfaceCount; ++i) {
      for (const scene::MeshVertex& vertex :
           model.model->surfaces[part.firstSurface + i].mesh.vertices) {
        const glm::dvec3 at(attachFromPart * glm::dvec4(vertex.position, 1.0));
        if (!box) box = AxisBox{at, at};
        box->least = glm::min(box->least, at);
        box->most = glm::max(box->most, at);
      }
    }
  }
  return box.value_or(AxisBox{});
}

std::vector<std::string> modelLines(const scene::Scene& scene) {
  std::vector<std::string> lines;
  for (const scene::SceneModel& model : scene.models) {
    const AxisBox box = attachedBox(model);
    const glm::dvec3 size = box.most - box.least;
    lines.push_back(fmt::format(
        "{}: on {}, {:.3g} x {:.3g} x {:.3g} m along its x, y, z; from {:.3g} to {:.3g} m above it",
        model.name, attachmentOf(model), size.x, size.y, size.z, box.least.z, box.most.z));
  }
  return lines;
}

std::vector<std::string> placementFindings(const scene::Scene& scene) {
  std::vector<std::string> findings;
  for (const scene::SceneModel& model : scene.models) {
    if (!std::holds_alternative<scene::FileSource>(model.source)) continue;
    const AxisBox box = attachedBox(model);
    const glm::dvec3 size = box.most - box.least;
    const bool standsAlongY = box.least.y > -0.05 * size.y;
    const bool isHalfBelow = box.least.z < -0.25 * size.z && box.most.z > 0.0;
    if (!standsAlongY || !isHalfBelow) continue;
    findings.push_back(fmt::format(
        "{}: reaches {:.3g} m behind {} and stands along its y: if the model's up is y, as in "
        "glTF, rotation_deg = [90, 0, 0] makes it stand up",
        model.name, -box.least.z, attachmentOf(model)));
  }
  return findings;
}

void drawSceneCheck(hal::Image& picture, const scene::Scene& scene,
                    const tracking::CameraModel& camera, const tracking::TrackingResult& tracking) {
  Overlay overlay(picture, camera);
  const auto& world = tracking.cameraFromWorld;
  if (world) overlay.axes(*world, kWorldAxisMetres);
  for (const tracking::TrackedTag& tag : tracking.tags) {
    const tracking::TagMarker* const marker = scene.findTag(tag.id);
    overlay.tag(tag, marker != nullptr);
    if (marker == nullptr || !tag.cameraFromTag) continue;
    overlay.axes(*tag.cameraFromTag * scene::kTagFromAttach, marker->edgeMetres);
  }
  for (const scene::SceneModel& model : scene.models) {
    std::optional<glm::dmat4> cameraFromAttach = model.tagId ? std::nullopt : world;
    for (const tracking::TrackedTag& tag : tracking.tags) {
      if (model.tagId == tag.id && tag.cameraFromTag) {
        cameraFromAttach = *tag.cameraFromTag * scene::kTagFromAttach;
      }
    }
    if (cameraFromAttach) overlay.box(*cameraFromAttach, attachedBox(model));
  }
}

}  // namespace pleinair::app
