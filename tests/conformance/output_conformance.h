#pragma once

// The contract of hal/output.h, run against every output in memory. A backend's test file includes
// this and says INSTANTIATE_TEST_SUITE_P(Name, OutputConformance, testing::Values(OutputCase{...}),
// outputCaseName) in namespace pleinair::hal::conformance.

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/image.h"
#include "hal/output.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::hal::conformance {

/// One output under test.
struct OutputCase {
  std::string name;  ///< letters and digits
  /// Makes it so that what it writes lies in `folder`.
  std::function<std::unique_ptr<MemoryOutput>(const std::filesystem::path& folder)> make;
  std::string backend;  ///< expected identity().backend
  std::string file;     ///< what it publishes in the folder, at the end; empty: nothing
  int maxPictures = 1000;
  std::string missing;        ///< why it cannot be tried here; empty: it can
  bool hasEvenSides = false;  ///< it answers odd sizes rounded up
};

inline void PrintTo(const OutputCase& output, std::ostream* out) {
  *out << output.name;
}
inline std::string outputCaseName(const testing::TestParamInfo<OutputCase>& info) {
  return info.param.name;
}

class OutputConformance : public testing::TestWithParam<OutputCase> {
 protected:
  void SetUp() override {
    if (!GetParam().missing.empty()) GTEST_SKIP() << GetParam().missing;
  }

  std::unique_ptr<MemoryOutput> make() { return GetParam().make(folder_.path()); }
  std::filesystem::path finalPath() const { return folder_.path() / GetParam().file; }

  static int pictures() { return std::min(GetParam().maxPictures, 5); }

  static FrameFormat startOrFail(MemoryOutput& output, FrameSize size) {
    const Result<OutputFormat> format =
        output.start({.size = size, .framePeriod = std::chrono::milliseconds(40)});
    EXPECT_TRUE(format.has_value()) << (format ? "" : format.error().message());
    return format.value_or(OutputFormat{}).frame;
  }

  /// A picture that differs from number to number, in planes with padded rows.
  struct Padded {
    std::array<std::vector<std::uint8_t>, 3> planes;
    ImageView view;
  };
  static Padded paddedPicture(FrameFormat format, int number) {
    constexpr std::size_t kPaddingBytes = 13;
    Padded picture{.planes = {}, .view = {.format = format, .planes = {}}};
    for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
      const std::size_t row = rowBytes(format.pixelFormat, plane, format.size.width);
      const auto rows =
          static_cast<std::size_t>(planeRows(format.pixelFormat, plane, format.size.height));
      auto& bytes = picture.planes[static_cast<std::size_t>(plane)];
      // The last row has no padding: whoever reads it reads past the end.
      bytes.resize((row + kPaddingBytes) * (rows - 1) + row);
      for (std::size_t i = 0; i < bytes.size(); ++i) {
        bytes[i] = static_cast<std::uint8_t>(i / 3 + static_cast<std::size_t>(number) * 40);
      }
      picture.view.planes[static_cast<std::size_t>(plane)] = {.bytes = bytes,
                                                              .strideBytes = row + kPaddingBytes};
    }
    return picture;
  }

  static void writeAll(MemoryOutput& output, FrameFormat format) {
    for (int i = 0; i < pictures(); ++i) {
      const Padded picture = paddedPicture(format, i);
      const Result<void> written = output.write(picture.view, i * std::chrono::milliseconds(40));
      ASSERT_TRUE(written.has_value()) << written.error().message();
    }
  }

  static std::string contents(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  support::TemporaryFolder folder_;
};

TEST_P(OutputConformance, SaysWhoItIs) {
  const std::unique_ptr<MemoryOutput> output = make();
  EXPECT_EQ(output->identity().backend, GetParam().backend);
  EXPECT_FALSE(output->identity().id.empty());
}

TEST_P(OutputConformance, AnswersAFormatOfTheRequestedSize) {
  for (const FrameSize size : {FrameSize{64, 48}, FrameSize{1, 1}, FrameSize{33, 17}}) {
    const std::unique_ptr<MemoryOutput> output = make();
    const FrameSize even{size.width + size.width % 2, size.height + size.height % 2};
    EXPECT_EQ(startOrFail(*output, size).size, GetParam().hasEvenSides ? even : size);
  }
}

TEST_P(OutputConformance, TakesPicturesOfEverySizeWithPaddedRows) {
  for (const FrameSize size :
       {FrameSize{64, 48}, FrameSize{1, 1}, FrameSize{33, 17}, FrameSize{2, 1}, FrameSize{1, 5}}) {
    SCOPED_TRACE(testing::Message() << size.width << "x" << size.height);
    const std::unique_ptr<MemoryOutput> output = make();
    const FrameFormat format = startOrFail(*output, size);
    writeAll(*output, format);
    const Result<void> finished = output->finish();
    ASSERT_TRUE(finished.has_value()) << finished.error().message();
    if (!GetParam().file.empty()) {
      EXPECT_TRUE(std::filesystem::exists(finalPath()));
    }
  }
}

TEST_P(OutputConformance, RefusesASizeBeyondTheLimits) {
  const std::unique_ptr<MemoryOutput> output = make();
  const Result<OutputFormat> format = output->start({.size = {8193, 4}});
  ASSERT_FALSE(format.has_value());
  EXPECT_EQ(format.error().kind, ErrorKind::kUnsupported);
}

TEST_P(OutputConformance, PublishesNothingBeforeTheEndAndLeavesWhatStoodThere) {
  if (GetParam().file.empty()) GTEST_SKIP() << "this output publishes no file at its end";
  std::ofstream(finalPath()) << "old";
  {
    const std::unique_ptr<MemoryOutput> output = make();
    const FrameFormat format = startOrFail(*output, {64, 48});
    writeAll(*output, format);
    EXPECT_EQ(contents(finalPath()), "old");
  }
  EXPECT_EQ(contents(finalPath()), "old");
  EXPECT_EQ(folder_.entryCount(), 1u) << "a temporary file was left behind";
}

TEST_P(OutputConformance, LeavesNoTemporaryFileBehind) {
  if (GetParam().file.empty()) GTEST_SKIP() << "this output publishes no file at its end";
  const std::unique_ptr<MemoryOutput> output = make();
  const FrameFormat format = startOrFail(*output, {64, 48});
  writeAll(*output, format);
  ASSERT_TRUE(output->finish().has_value());
  EXPECT_EQ(folder_.entryCount(), 1u);
}

TEST_P(OutputConformance, GivesTheSameBytesForTheSamePictures) {
  if (GetParam().file.empty()) GTEST_SKIP() << "this output publishes no file at its end";
  std::string first;
  for (int run = 0; run < 2; ++run) {
    const std::unique_ptr<MemoryOutput> output = make();
    const FrameFormat format = startOrFail(*output, {160, 120});
    writeAll(*output, format);
    ASSERT_TRUE(output->finish().has_value());
    if (run == 0) first = contents(finalPath());
  }
  EXPECT_FALSE(first.empty());
  EXPECT_TRUE(contents(finalPath()) == first);
}

TEST_P(OutputConformance, IsDestroyedInAnyState) {
  make();
  startOrFail(*make(), {64, 48});
  const std::unique_ptr<MemoryOutput> written = make();
  const FrameFormat format = startOrFail(*written, {64, 48});
  writeAll(*written, format);
}

}  // namespace pleinair::hal::conformance
