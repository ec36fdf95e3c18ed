// Prints the tables of poses in docs/measured.md as Markdown: `tracking_report [PART ...] [SHOT
// ...]`, where a part is lag, hidden, tremble, poses or covariance, and a shot is desk, virtual or
// one of the workbench's; all by default. Takes minutes.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "tests/reports/tracking/pose_measures.h"
#include "tests/unit/tracking/desk_sequence.h"

namespace pleinair::tracking {
namespace {

using hal::SyntheticShot;

const char* nameOf(Layout layout) {
  return layout == Layout::kWorld ? "all tags, one world" : "each tag by itself";
}

TruthSequence bench(SyntheticShot shot, std::size_t frames = 90) {
  return filmWorkbench({.shot = shot, .frameCount = frames});
}

std::set<int> idsOf(const TruthSequence& sequence) {
  std::set<int> ids;
  for (const TagMarker& marker : sequence.markers) ids.insert(marker.id);
  return ids;
}

void reportPoses(const TruthSequence& sequence, Layout layout) {
  std::vector<double> mm;
  std::vector<double> degrees;
  std::vector<double> px;
  std::size_t visible = 0;
  const std::vector<TrackedPoses> told = trackAll(sequence, layout);
  for (std::size_t i = 0; i < told.size(); ++i) {
    for (const int id : sequence.frames[i].visible) {
      ++visible;
      const auto tag = told[i].tags.find(id);
      if (tag == told[i].tags.end()) continue;
      const ModelError error = modelError(sequence, i, id, *tag->second.cameraFromTag);
      mm.push_back(error.translationMm);
      degrees.push_back(error.rotationDegrees);
      px.push_back(error.px);
    }
  }
  std::printf("| %s, %s | %zu of %zu | %.2f / %.2f | %.3f / %.3f | %.3f / %.3f |\n",
              sequence.name.c_str(), nameOf(layout), px.size(), visible, percentile(mm, 0.5),
              percentile(mm, 0.95), percentile(degrees, 0.5), percentile(degrees, 0.95),
              percentile(px, 0.5), percentile(px, 0.95));
}

void reportAllPoses(const std::vector<TruthSequence>& sequences) {
  std::printf(
      "\n### Poses: median / 95th percentile\n\n"
      "| | tags with a pose, of visible ones | mm | degrees | px of a cube on the tag |\n"
      "|---|---|---|---|---|\n");
  for (const TruthSequence& sequence : sequences) {
    for (const Layout layout : {Layout::kWorld, Layout::kLoose}) reportPoses(sequence, layout);
  }
}

void reportTremble(const TruthSequence& still) {
  std::printf(
      "\n### Tremble: RMS px of a cube on a tag, a still camera with noise of 2 levels\n\n"
      "| | tag | about its mean | frame to frame |\n|---|---|---|---|\n");
  for (const Layout layout : {Layout::kWorld, Layout::kLoose}) {
    const std::vector<TrackedPoses> told = trackAll(still, layout);
    for (const int id : idsOf(still)) {
      if (!still.frames.front().visible.contains(id)) continue;
      const Tremble tremble = trembleOf(still, told, id, 30);
      std::printf("| %s | %d | %.4f | %.4f |\n", nameOf(layout), id, tremble.aboutMean,
                  tremble.frameToFrame);
    }
  }
}

void reportLag(const std::vector<TruthSequence>& sequences) {
  std::printf(
      "\n### Lag: ms that a model comes after the truth, and what is the error then\n\n"
      "| | tags: ms | the fastest fifth of frames: px, median / 95th percentile |\n"
      "|---|---|---|\n");
  for (const TruthSequence& sequence : sequences) {
    for (const Layout layout : {Layout::kWorld, Layout::kLoose}) {
      const std::vector<TrackedPoses> told = trackAll(sequence, layout);
      std::string lags;
      std::vector<std::pair<double, double>> speedAndError;
      for (const int id : idsOf(sequence)) {
        const TagMarker& marker = sequence.marker(id);
        std::size_t poses = 0;
        for (std::size_t i = 1; i < told.size(); ++i) {
          const auto tag = told[i].tags.find(id);
          if (tag == told[i].tags.end() || !sequence.frames[i].visible.contains(id)) continue;
          ++poses;
          const auto at = [&](std::size_t frame) {
            return modelPx(sequence.camera,
                           sequence.frames[frame].cameraFromWorld * *marker.worldFromTag,
                           marker.edgeMetres);
          };
          speedAndError.emplace_back(rmsBetween(at(i), at(i - 1)),
                                     modelError(sequence, i, id, *tag->second.cameraFromTag).px);
        }
        if (poses * 2 < told.size()) continue;
        char text[64];
        std::snprintf(text, sizeof text, "%s%d: %.1f", lags.empty() ? "" : ", ", id,
                      lagMs(sequence, told, id));
        lags += text;
      }
      std::ranges::sort(speedAndError);
      std::vector<double> fast;
      for (std::size_t i = speedAndError.size() * 4 / 5; i < speedAndError.size(); ++i) {
        fast.push_back(speedAndError[i].second);
      }
      std::printf("| %s, %s | %s | %.3f / %.3f |\n", sequence.name.c_str(), nameOf(layout),
                  lags.c_str(), percentile(fast, 0.5), percentile(fast, 0.95));
    }
  }
}

void reportHiddenRow(const TruthSequence& sequence, Layout layout, const Hiding& hiding) {
  HiddenResult all;
  const auto add = [&](const HiddenResult& one) {
    all.times += one.times;
    all.framesHidden += one.framesHidden;
    all.framesLost += one.framesLost;
    all.driftPx.insert(all.driftPx.end(), one.driftPx.begin(), one.driftPx.end());
    all.jumpPx.insert(all.jumpPx.end(), one.jumpPx.begin(), one.jumpPx.end());
    all.settlePx.insert(all.settlePx.end(), one.settlePx.begin(), one.settlePx.end());
  };
  const std::set<int> ids = idsOf(sequence);
  if (layout == Layout::kWorld) {
    const std::vector<TrackedPoses> told = trackAll(sequence, layout, {}, hidden(hiding));
    for (const int id : ids) add(hiddenResult(sequence, told, id, hiding));
  } else {
    for (const int id : ids) {
      const std::vector<TrackedPoses> told = trackAll(sequence, layout, {}, hidden(hiding, id));
      add(hiddenResult(sequence, told, id, hiding));
    }
  }
  std::printf(
      "| %s, %s%s | %.2f s × %zu | %zu of %zu | %.2f / %.2f | %.2f / %.2f | %.2f |\n",
      sequence.name.c_str(), layout == Layout::kWorld ? "all tags hidden" : "a tag by itself",
      hiding.part < 1.0 ? ", half of it" : "", static_cast<double>(hiding.hiddenFrames) / 30.0,
      all.times, all.framesLost, all.framesHidden, percentile(all.driftPx, 0.5),
      percentile(all.driftPx, 0.95), percentile(all.jumpPx, 0.5), percentile(all.jumpPx, 0.95),
      percentile(all.settlePx, 0.5));
}

void reportHidden(const std::vector<TruthSequence>& sequences) {
  std::printf(
      "\n### A hidden tag: px of a cube on it, median / 95th percentile of all times\n\n"
      "| | hidden | frames without a pose | drift | jump at the return | error 10 frames later |\n"
      "|---|---|---|---|---|---|\n");
  for (const TruthSequence& sequence : sequences) {
    for (const Layout layout : {Layout::kWorld, Layout::kLoose}) {
      reportHiddenRow(sequence, layout, {.hiddenFrames = 6});
      reportHiddenRow(sequence, layout, {.hiddenFrames = 14});
      if (layout == Layout::kLoose) {
        reportHiddenRow(sequence, layout, {.hiddenFrames = 14, .part = 0.5});
      }
    }
  }
}

/// The ratio of actual to predicted errors, measured on a model on a tag.
void reportCovariance(const std::vector<TruthSequence>& sequences) {
  std::printf(
      "\n### Errors against predicted ones, px of a cube on a tag, RMS\n\n"
      "| | seen: actual / predicted | hidden for 0.47 s: actual / predicted |\n"
      "|---|---|---|\n");
  for (const TruthSequence& sequence : sequences) {
    for (const Layout layout : {Layout::kWorld, Layout::kLoose}) {
      const Hiding hiding{.hiddenFrames = 14};
      const auto plain = predictedErrors(sequence, trackAll(sequence, layout));
      const auto hiddenTold = trackAll(sequence, layout, {}, hidden(hiding));
      const auto covered = predictedErrors(sequence, hiddenTold, PoseSource::kCarried);
      std::printf("| %s, %s | %.3f / %.3f = %.2f | %.3f / %.3f = %.2f |\n", sequence.name.c_str(),
                  nameOf(layout), plain.actualPx, plain.predictedPx,
                  plain.actualPx / plain.predictedPx, covered.actualPx, covered.predictedPx,
                  covered.actualPx / covered.predictedPx);
    }
  }
}

constexpr std::array<const char*, 5> kParts{"lag", "hidden", "tremble", "poses", "covariance"};

int report(const std::set<std::string>& words) {
  std::set<std::string> parts;
  std::set<std::string> names;
  for (const std::string& word : words) {
    (std::ranges::find(kParts, word) != kParts.end() ? parts : names).insert(word);
  }
  const auto wants = [&](const char* part) { return parts.empty() || parts.contains(part); };
  const auto wantsSequence = [&](const char* name) {
    return names.empty() || names.contains(name);
  };
  std::vector<TruthSequence> moving;
  if (hasDeskSequence() && wantsSequence("desk")) moving.push_back(readDesk());
  if (hasVirtualCamera() && wantsSequence("virtual")) moving.push_back(readVirtualCamera());
  for (const SyntheticShot shot : {SyntheticShot::kWalkaround, SyntheticShot::kPan,
                                   SyntheticShot::kDolly, SyntheticShot::kRoll}) {
    if (wantsSequence(toString(shot).data())) moving.push_back(bench(shot, 150));
  }
  if (wants("lag")) reportLag(moving);
  if (wants("hidden")) reportHidden(moving);
  if (wantsSequence("still")) {
    const TruthSequence still = bench(SyntheticShot::kStill, 150);
    if (wants("tremble")) reportTremble(still);
    moving.push_back(still);
  }
  if (wantsSequence("occluder")) moving.push_back(bench(SyntheticShot::kOccluder, 180));
  if (wants("poses")) reportAllPoses(moving);
  if (wants("covariance")) reportCovariance(moving);
  return 0;
}

}  // namespace
}  // namespace pleinair::tracking

int main(int argc, char** argv) {
  return pleinair::tracking::report({argv + 1, argv + argc});
}
