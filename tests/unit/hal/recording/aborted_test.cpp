// Recordings that are truncated or damaged inside deliver their valid frames, and no others.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/outputs/headless/headless_output.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::hal {
namespace {

constexpr int kFrames = 130;
constexpr FrameSize kSize{64, 48};

std::string readAll(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void writeAll(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

struct Box {
  std::size_t at;
  std::size_t bytes;
  std::string type;
};

std::vector<Box> boxesOf(const std::string& mp4) {
  std::vector<Box> boxes;
  for (std::size_t at = 0; at + 8 <= mp4.size();) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) size = size << 8 | static_cast<unsigned char>(mp4[at + i]);
    if (size < 8) break;
    boxes.push_back({.at = at, .bytes = size, .type = mp4.substr(at + 4, 4)});
    at += size;
  }
  return boxes;
}

/// Nothing tells that a file which ends with a whole fragment is not complete.
bool endsWithABox(const std::vector<Box>& boxes, std::size_t bytes) {
  return std::ranges::any_of(boxes, [bytes](const Box& each) { return each.at == bytes; });
}

std::string layoutOf(const std::string& mp4) {
  std::string layout;
  for (const Box& box : boxesOf(mp4)) {
    layout += " " + box.type + "@" + std::to_string(box.at) + "+" + std::to_string(box.bytes);
  }
  return layout;
}

class Aborted : public testing::Test {
 protected:
  void record(const std::filesystem::path& whole) {
    support::writeMedia(whole, kFrames, kSize);
    bytes_ = readAll(whole);
    const Result<support::Played> played = support::play(whole);
    ASSERT_TRUE(played) << played.error().message();
    ASSERT_EQ(played->frames.size(), static_cast<std::size_t>(kFrames));
    for (std::size_t i = 0; i < played->frames.size(); ++i) {
      sound_[played->times[i]] = hashOf(played->frames[i].image.map().view());
    }
  }

  /// Each frame must equal the complete recording's frame at that time.
  void expectSound(const support::Played& played) const {
    for (std::size_t i = 0; i < played.frames.size(); ++i) {
      const auto sound = sound_.find(played.times[i]);
      ASSERT_NE(sound, sound_.end()) << "frame " << i << " at " << played.times[i].count();
      EXPECT_EQ(hashOf(played.frames[i].image.map().view()), sound->second) << "frame " << i;
    }
  }

  support::TemporaryFolder folder_;
  std::string bytes_;
  std::map<Duration, std::uint64_t> sound_;
};

class AbortedRecording : public Aborted, public testing::WithParamInterface<std::string> {
 protected:
  void SetUp() override { record(folder_.path() / ("whole." + GetParam())); }
};

TEST_P(AbortedRecording, GivesItsSoundFramesAndSaysSo) {
  const auto cut = folder_.path() / ("cut." + GetParam());
  std::size_t longest = 0;
  const std::vector<Box> boxes = GetParam() == "mp4" ? boxesOf(bytes_) : std::vector<Box>();
  for (int tenth = 0; tenth < 10; ++tenth) {
    // 11 bytes beyond the round number: inside a frame, a box or a block.
    std::size_t bytes = bytes_.size() * static_cast<unsigned>(tenth) / 10 + 11;
    if (endsWithABox(boxes, bytes)) ++bytes;
    SCOPED_TRACE(testing::Message() << bytes << " bytes of " << bytes_.size()
                                    << (GetParam() == "mp4" ? layoutOf(bytes_) : ""));
    writeAll(cut, bytes_.substr(0, bytes));
    const Result<support::Played> played = support::play(cut);
    if (!played) {
      EXPECT_EQ(played.error().kind, ErrorKind::kInvalidInput) << played.error().message();
      continue;
    }
    EXPECT_LT(played->frames.size(), static_cast<std::size_t>(kFrames));
    longest = std::max(longest, played->frames.size());
    expectSound(*played);
    const auto* end = std::get_if<EndOfStream>(&played->ending);
    ASSERT_NE(end, nullptr);
    ASSERT_TRUE(end->truncated);
    EXPECT_EQ(end->truncated->kind, ErrorKind::kInvalidInput);
    EXPECT_THAT(end->truncated->message(), testing::StartsWith(cut.string() + ": "));
  }
  EXPECT_GT(longest, 50u);
}

// A recorder whose power was cut.
TEST_F(Aborted, WithinTheHeadOfALaterFragmentGivesTheFragmentsBefore) {
  const std::filesystem::path whole = folder_.path() / "whole.mp4";
  const std::filesystem::path cut = folder_.path() / "cut.mp4";
  record(whole);
  std::size_t heads = 0;
  for (const Box& box : boxesOf(bytes_)) {
    if (box.type != "moof" || heads++ == 0) continue;
    writeAll(cut, bytes_.substr(0, box.at));
    const Result<support::Played> before = support::play(cut);
    ASSERT_TRUE(before) << before.error().message();
    for (std::size_t bytes = 1; bytes < box.bytes; bytes += 27) {
      SCOPED_TRACE(testing::Message()
                   << bytes << " bytes of the head at " << box.at << layoutOf(bytes_));
      writeAll(cut, bytes_.substr(0, box.at + bytes));
      const Result<support::Played> played = support::play(cut);
      ASSERT_TRUE(played) << played.error().message();
      EXPECT_EQ(played->frames.size(), before->frames.size());
      expectSound(*played);
      const auto* end = std::get_if<EndOfStream>(&played->ending);
      ASSERT_NE(end, nullptr);
      EXPECT_TRUE(end->truncated);
    }
  }
  EXPECT_GE(heads, 3u);
}

// Its data follows, so that it is not cut.
TEST_F(Aborted, AHeadWhoseSizeIsDamagedIsRead) {
  const std::filesystem::path whole = folder_.path() / "whole.mp4";
  const std::filesystem::path damaged = folder_.path() / "damaged.mp4";
  record(whole);
  const std::vector<Box> boxes = boxesOf(bytes_);
  const auto isHead = [](const Box& box) { return box.type == "moof"; };
  const auto first = std::ranges::find_if(boxes, isHead);
  ASSERT_NE(first, boxes.end());
  std::string bytes = bytes_;
  bytes[first->at] = 0x01;  // 16 MiB more
  writeAll(damaged, bytes);
  const Result<support::Played> played = support::play(damaged);
  ASSERT_TRUE(played) << played.error().message();
  EXPECT_GT(played->frames.size(), 0u);
  expectSound(*played);
}

TEST_P(AbortedRecording, SurvivesDamageAnywhere) {
  const auto damaged = folder_.path() / ("damaged." + GetParam());
  for (unsigned seed = 1; seed <= 25; ++seed) {
    SCOPED_TRACE(seed);
    std::string bytes = bytes_;
    std::uint32_t state = seed;
    for (int i = 0; i < 6; ++i) {
      state = state * 1664525u + 1013904223u;
      bytes[state % bytes.size()] ^= static_cast<char>(1 + (state >> 24));
    }
    writeAll(damaged, bytes);
    const Result<support::Played> played = support::play(damaged, {}, 2 * kFrames);
    if (!played) {
      EXPECT_THAT(played.error().message(), testing::StartsWith(damaged.string() + ": "));
      continue;
    }
    for (const CapturedFrame& frame : played->frames) EXPECT_TRUE(frame.image.isComplete());
    EXPECT_TRUE(std::is_sorted(played->times.begin(), played->times.end()));
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, AbortedRecording, testing::Values("mp4", "mkv", "y4m"),
                         [](const auto& kind) { return kind.param; });

TEST(BrokenFolder, LeavesBrokenPicturesOutAndCountsThem) {
  const support::TemporaryFolder folder;
  support::writeMedia(folder.path() / "%d.png", 5, kSize);
  const std::string png = readAll(folder.path() / "0.png");
  for (const char* name : {"1.png", "2.png", "4.png"}) {
    writeAll(folder.path() / name, png.substr(0, png.size() - 20));
  }
  const Result<support::Played> played = support::play(folder.path());
  ASSERT_TRUE(played) << played.error().message();
  ASSERT_EQ(played->frames.size(), 2u);
  EXPECT_EQ(played->frames[1].sequence, 3u);
  EXPECT_EQ(played->frames[1].droppedBefore, 2u);
  EXPECT_EQ(played->times[1], 3 * RecordingOptions{}.picturePeriod);
  ASSERT_TRUE(std::get<EndOfStream>(played->ending).truncated);
  EXPECT_THAT(std::get<EndOfStream>(played->ending).truncated->message(),
              testing::HasSubstr("4.png: is a broken picture"));
}

}  // namespace
}  // namespace pleinair::hal
