// Prints what tells a cut from motion, light and occlusion, over films with and without cuts: the
// table of docs/decisions/0025-cuts.md. Arguments: further films without a cut.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "hal/cameras/synthetic/render/shot.h"
#include "pipeline/tracking/image/luma.h"
#include "pipeline/tracking/image/luma_pyramid.h"
#include "pipeline/tracking/motion/cut_detector.h"
#include "pipeline/tracking/motion/feature_tracker.h"
#include "pipeline/tracking/motion/image_motion_estimator.h"
#include "pipeline/tracking/motion/view_comparison.h"
#include "tests/reports/tracking/cut_films.h"

namespace pleinair::tracking {
namespace {

const std::string kData = PLEINAIR_SHARED_DATA;

struct Cues {
  double found = 1.0;
  double correlation = 1.0;
  double shared = 1.0;      // of the earlier frame's blocks in the later one
  double sharedBack = 1.0;  // and the other way round
  std::size_t textured = 0;
  std::size_t texturedAfter = 0;
  bool isCut = false;
};

class Viewer {
 public:
  Cues see(const cv::Mat& image) {
    const hal::PlaneView plane{.bytes = {image.data, image.total()},
                               .strideBytes = static_cast<std::size_t>(image.step)};
    LumaFrame luma;
    luma.take(plane, {image.cols, image.rows});
    const auto pyramid = luma.pyramid();
    Cues out;
    tracker_->follow(pyramid, 2.0);
    out.found = tracker_->foundShare();
    Thumbnail thumbnail;
    thumbnail.load(*pyramid);
    ViewComparison::View view;
    view.load(*pyramid);
    if (hasPast_) {
      out.correlation = thumbnail_.match(thumbnail).correlation;
      const auto start = std::chrono::steady_clock::now();
      const auto there = comparison_.compare(view_, view, 2.0);
      const auto back = comparison_.compare(view, view_, 2.0);
      milliseconds_.push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
              .count());
      out.shared = there.sharedPart;
      out.textured = there.textured;
      out.sharedBack = back.sharedPart;
      out.texturedAfter = back.textured;
    }
    thumbnail_ = thumbnail;
    view_ = view;
    hasPast_ = true;
    out.isCut = estimator_.follow(plane, {image.cols, image.rows}, sequence_++).isCut;
    return out;
  }

  static double medianMilliseconds() {
    std::ranges::sort(milliseconds_);
    return milliseconds_.empty() ? 0.0 : milliseconds_[milliseconds_.size() / 2];
  }

 private:
  std::unique_ptr<FeatureTracker> tracker_ = makeFeatureTracker(FeatureMethod::kLucasKanade);
  ImageMotionEstimator estimator_{{.flow = false}};
  Thumbnail thumbnail_;
  ViewComparison::View view_;
  ViewComparison comparison_;
  bool hasPast_ = false;
  std::uint64_t sequence_ = 0;
  inline static std::vector<double> milliseconds_;  // of both comparisons, of all films
};

void print(const std::string& name, const Cues& cues, const std::string& more) {
  std::printf("| %s | %.2f | %.2f | %.2f | %.2f | %zu / %zu | %s |\n", name.c_str(), cues.found,
              cues.correlation, cues.shared, cues.sharedBack, cues.textured, cues.texturedAfter,
              more.c_str());
  std::fflush(stdout);
}

/// One film, then another.
void cut(const std::string& name, const Film& before, const Film& after) {
  if (before.empty() || after.empty()) return;
  Viewer viewer;
  for (std::size_t i = 0; i < 6; ++i) {
    // A single picture becomes a film of a standing camera.
    viewer.see(before.size() == 1 ? noisy(before[0], static_cast<unsigned>(i))
                                  : before[before.size() - 6 + i]);
  }
  const Cues cues = viewer.see(after.size() == 1 ? noisy(after[0], 99) : after[0]);
  print(name, cues, cues.isCut ? "cut" : "MISSED");
}

/// A film without a cut: the frame that looks most like one.
void noCut(const std::string& name, const Film& film) {
  if (film.empty()) return;
  Viewer viewer;
  Cues least;
  std::size_t at = 0;
  std::size_t cuts = 0;
  std::size_t compared = 0;
  std::string where;
  double leastFound = 1.0;
  for (std::size_t i = 0; i < film.size(); ++i) {
    const Cues cues = viewer.see(film[i]);
    if (i == 0) continue;
    leastFound = std::min(leastFound, cues.found);
    if (cues.isCut) {
      ++cuts;
      where += " " + std::to_string(i);
    }
    // Views are compared where features were lost, and can be where there is texture.
    const bool isCompared = cues.found < 0.9 && std::min(cues.textured, cues.texturedAfter) >= 6;
    if (!isCompared) continue;
    ++compared;
    if (std::max(cues.shared, cues.sharedBack) < std::max(least.shared, least.sharedBack)) {
      least = cues;
      at = i;
    }
  }
  char text[128];
  std::snprintf(text, sizeof text, "frame %zu, %zu of %zu compared, found ≥ %.2f%s", at, compared,
                film.size(), leastFound, cuts > 0 ? ", FALSE CUTS" : "");
  print(name, least, text + where);
}

Film one(const cv::Mat& image) {
  return image.empty() ? Film{} : Film{image};
}

void cutsOf(const std::string& name, const Film& film) {
  if (film.size() < 12) return;
  const Film start(film.begin(), film.begin() + 6);
  const auto cropped = [&](double x, double y, double part) {
    Film out;
    for (const cv::Mat& image : start) out.push_back(crop(image, x, y, part));
    return out;
  };
  cut(name + ": whole → 1.6× crop", start, one(crop(film[6], 0.19, 0.19, 0.62)));
  cut(name + ": 1.6× crop → whole", cropped(0.19, 0.19, 0.62), one(film[6]));
  cut(name + ": whole → 2× crop", start, one(crop(film[6], 0.25, 0.25, 0.5)));
  cut(name + ": left → right third", cropped(0.0, 0.3, 0.34), one(crop(film[6], 0.66, 0.3, 0.34)));
  cut(name + ": right → left third", cropped(0.66, 0.3, 0.34), one(crop(film[6], 0.0, 0.3, 0.34)));
  cut(name + ": moved by a third", cropped(0.0, 0.1, 0.75), one(crop(film[6], 0.25, 0.1, 0.75)));
  cut(name + ": moved down by a third", cropped(0.1, 0.0, 0.75),
      one(crop(film[6], 0.1, 0.25, 0.75)));
  cv::Mat mirrored;
  cv::flip(film[6], mirrored, 1);
  cut(name + ": mirrored", start, one(mirrored));
}

}  // namespace
}  // namespace pleinair::tracking

int main(int argc, char** argv) {
  using namespace pleinair::tracking;
  using pleinair::hal::SyntheticShot;
  const auto shotNames = pleinair::hal::syntheticShots();
  std::printf(
      "### Cuts\n\n| film | found | correlation | shared | back | blocks | |\n"
      "|---|---|---|---|---|---|---|\n");
  const Film bench = workbench(SyntheticShot::kWalkaround, 0, 12);
  const Film far = workbench(SyntheticShot::kVisitors, 60, 12);
  const Film desk = recording(kData + "/sequences/desk_6dof/planar6dof_720p_slow.mp4", 0, 150);
  const Film walk = recording(kData + "/sequences/room_walk", 0, 41);
  const Film shaken =
      recording(kData + "/sequences/virtual_camera/room_wide_IMG_1455_640x480.mp4", 0, 90);
  cutsOf("walkaround", bench);
  cutsOf("visitors", far);
  if (desk.size() > 20) cutsOf("desk_6dof", Film(desk.begin(), desk.begin() + 12));
  cutsOf("virtual_camera", shaken.empty() ? shaken : Film(shaken.begin(), shaken.begin() + 12));
  for (int i = 1; i < argc; ++i) {
    cutsOf(std::filesystem::path(argv[i]).stem().string(), recording(argv[i], 0, 12));
  }
  cut("walkaround → visitors", bench, far);
  cut("visitors → walkaround", far, bench);
  for (const std::size_t second : {1U, 2U, 3U, 5U, 7U, 9U}) {
    const Film film = workbench(SyntheticShot::kCut, 60 * second - 6, 8);
    cut("shot cut at " + std::to_string(2 * second) + " s", Film(film.begin(), film.end() - 1),
        one(film.back()));
  }
  cut("walkaround → the same 6 s later", bench, workbench(SyntheticShot::kWalkaround, 180, 1));
  cut("walkaround → the same 12 s later", bench, workbench(SyntheticShot::kWalkaround, 360, 1));
  if (desk.size() > 140)
    cut("desk_6dof → the same later", Film(desk.begin(), desk.begin() + 9), one(desk[140]));
  for (std::size_t i = 0; i + 9 < walk.size(); i += 6) {
    cut("room_walk " + std::to_string(i) + " → " + std::to_string(i + 9), one(walk[i]),
        one(walk[i + 9]));
  }
  const char* const photos[] = {"astronaut.png", "brick.png",  "camera.png",
                                "chelsea.png",   "coffee.png", "coins.png",
                                "grass.png",     "gravel.png", "hubble_deep_field.jpg",
                                "page.png",      "retina.jpg", "rocket.jpg"};
  const cv::Mat firstPhoto = photo("rocket.jpg");
  cv::Mat before = firstPhoto;
  std::string nameBefore = "rocket.jpg";
  for (const char* name : photos) {
    const cv::Mat image = photo(name);
    if (image.empty()) break;
    cut(nameBefore + " → " + name, one(before), one(image));
    cut(std::string(name) + ": left → right half", one(crop(image, 0.0, 0.2, 0.5)),
        one(crop(image, 0.5, 0.3, 0.5)));
    before = image;
    nameBefore = name;
  }

  std::printf(
      "\n### No cuts\n\n| film | found | correlation | shared | back | blocks | |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const auto shot : shotNames) {
    const auto which = *pleinair::hal::syntheticShotNamed(shot);
    if (which == SyntheticShot::kCut) continue;
    const std::size_t count = which == SyntheticShot::kLights ? 250 : 90;
    const std::size_t first = which == SyntheticShot::kVisitors ? 60 : 0;
    noCut(std::string(shot), workbench(which, first, count));
    noCut(std::string(shot) + ", every 3rd", workbench(which, first, 40, 3));
  }
  noCut("desk_6dof", desk);
  noCut("virtual_camera", shaken);
  const auto every = [](const Film& film, std::size_t step) {
    Film out;
    for (std::size_t i = 0; i < film.size(); i += step) out.push_back(film[i]);
    return out;
  };
  noCut("desk_6dof, every 3rd", every(desk, 3));
  noCut("virtual_camera, every 3rd", every(shaken, 3));
  for (int i = 1; i < argc; ++i) {
    const std::string stem = std::filesystem::path(argv[i]).stem().string();
    noCut(stem, recording(argv[i], 0, 200));
    noCut(stem + ", every 3rd", recording(argv[i], 0, 60, 3));
  }
  // Pans over pictures that are larger than the frame; blurred as in an exposure of the whole
  // period, too.
  std::vector<std::pair<std::string, cv::Mat>> stills{{"walkaround", bench[0]}};
  if (!far.empty()) stills.emplace_back("visitors", far[0]);
  if (!walk.empty()) stills.emplace_back("room_walk", walk[0]);
  if (!walk.empty()) stills.emplace_back("room_walk, last", walk.back());
  for (const char* name :
       {"astronaut.png", "coffee.png", "chelsea.png", "brick.png", "rocket.jpg", "grass.png"}) {
    const cv::Mat image = photo(name);
    if (!image.empty()) stills.emplace_back(name, image);
  }
  for (const auto& [name, still] : stills) {
    for (const int step : {20, 40, 60, 90}) {
      for (const bool blurs : {false, true}) {
        noCut(name + ": pan of " + std::to_string(step) + " px" + (blurs ? ", blurred" : ""),
              panOver(still, step, blurs));
      }
    }
    // Of a camera that stands: the light halves, a lamp comes on at one side, a flash, a hand on
    // the lens.
    const cv::Mat view = still;
    const auto film = [&](const std::function<void(cv::Mat&, int)>& change) {
      Film out;
      for (int i = 0; i < 20; ++i) {
        cv::Mat each = view.clone();
        change(each, i);
        out.push_back(noisy(each, static_cast<unsigned>(i)));
      }
      return out;
    };
    noCut(name + ": light off", film([](cv::Mat& m, int i) {
            if (i >= 8) m.convertTo(m, -1, 0.35, 0.0);
          }));
    noCut(name + ": lamp on", film([](cv::Mat& m, int i) {
            if (i < 8) return;
            for (int y = 0; y < m.rows; ++y) {
              for (int x = 0; x < m.cols; ++x) {
                auto& px = m.at<unsigned char>(y, x);
                px = cv::saturate_cast<unsigned char>(px * (0.5 + 1.8 * x / m.cols));
              }
            }
          }));
    noCut(name + ": overexposed flash", film([](cv::Mat& m, int i) {
            if (i == 8) m.convertTo(m, -1, 1.6, 90.0);
          }));
    noCut(name + ": white frame", film([](cv::Mat& m, int i) {
            if (i == 8) m.setTo(250);
          }));
    noCut(name + ": black frames", film([](cv::Mat& m, int i) {
            if (i >= 8 && i < 12) m.setTo(12);
          }));
    noCut(name + ": occluder", film([](cv::Mat& m, int i) {
            if (i < 4) return;
            const int w = std::min(450, 120 * (i - 3));
            cv::Mat hand = m(cv::Rect(0, 0, w, m.rows));
            for (int y = 0; y < hand.rows; ++y) {
              for (int x = 0; x < hand.cols; ++x) {
                hand.at<unsigned char>(y, x) =
                    static_cast<unsigned char>(120 + 60 * x / hand.cols - 30 * y / hand.rows);
              }
            }
          }));
    noCut(name + ": hand on the lens", film([](cv::Mat& m, int i) {
            if (i < 6 || i > 14) return;
            const int w = std::min(m.cols, 160 * (std::min(i, 20 - i) - 5));
            cv::Mat hand = m(cv::Rect(0, 0, w, m.rows));
            for (int y = 0; y < hand.rows; ++y) {
              for (int x = 0; x < hand.cols; ++x) {
                hand.at<unsigned char>(y, x) =
                    static_cast<unsigned char>(70 + 50 * x / m.cols - 30 * y / m.rows);
              }
            }
          }));
  }
  std::printf("\nTwo comparisons of views: %.1f ms\n", Viewer::medianMilliseconds());
}
