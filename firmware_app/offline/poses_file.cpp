#include "firmware_app/offline/poses_file.h"

#include <utility>

#include <nlohmann/json.hpp>

namespace pleinair::app {
namespace {

using Json = nlohmann::ordered_json;

Json rowMajor(const glm::dmat4& matrix) {
  Json numbers = Json::array();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) numbers.push_back(matrix[column][row]);
  }
  return numbers;
}

const char* nameOf(tracking::PoseSource source) {
  return source == tracking::PoseSource::kSeen ? "seen" : "carried";
}

Json tagJson(const tracking::TrackedTag& tag) {
  Json json{{"id", tag.id}, {"corners", Json::array()}};
  for (const glm::dvec2& corner : tag.corners) json["corners"].push_back({corner.x, corner.y});
  if (tag.cameraFromTag) json["cameraFromTag"] = rowMajor(*tag.cameraFromTag);
  if (tag.source != tracking::PoseSource::kSeen) json["source"] = nameOf(tag.source);
  return json;
}

}  // namespace

std::string posesLine(std::uint64_t frame, hal::Duration time,
                      const tracking::TrackingResult& tracking) {
  Json json{{"frame", frame}, {"time_s", hal::toSeconds(time)}};
  if (tracking.cameraFromWorld) {
    json["cameraFromWorld"] = rowMajor(*tracking.cameraFromWorld);
    if (tracking.worldSource != tracking::PoseSource::kSeen) {
      json["worldSource"] = nameOf(tracking.worldSource);
    }
  }
  json["tags"] = Json::array();
  for (const tracking::TrackedTag& tag : tracking.tags) json["tags"].push_back(tagJson(tag));
  for (const tracking::Rejection& rejection : tracking::rejections(tracking.counted)) {
    if (rejection.count > 0) json["rejected"][std::string(rejection.reason)] = rejection.count;
  }
  return json.dump() + "\n";
}

hal::Result<PosesFile> PosesFile::create(const std::filesystem::path& path) {
  auto file = hal::PendingFile::create(path);
  if (!file) return tl::unexpected(std::move(file.error()));
  return PosesFile(std::move(*file));
}

hal::Result<void> PosesFile::write(std::uint64_t frame, hal::Duration time,
                                   const tracking::TrackingResult& tracking) {
  const std::string line = posesLine(frame, time, tracking);
  return file_.write({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()});
}

hal::Result<void> PosesFile::publish() {
  return file_.publish();
}

}  // namespace pleinair::app
