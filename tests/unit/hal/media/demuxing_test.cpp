// Times of streams that are broken or hostile.
#include "hal/media/demuxing.h"

#include <chrono>
#include <cstdint>

#include <gtest/gtest.h>

namespace pleinair::hal::libav {
namespace {

using namespace std::chrono_literals;

struct FreeContext {
  void operator()(AVFormatContext* context) const { avformat_free_context(context); }
};

class StreamTimes : public testing::Test {
 protected:
  std::unique_ptr<AVFormatContext, FreeContext> context_{avformat_alloc_context()};
  AVStream* stream_ = avformat_new_stream(context_.get(), nullptr);
};

TEST_F(StreamTimes, CountFromTheFirst) {
  stream_->time_base = {1, 90'000};
  stream_->start_time = 1000;
  EXPECT_EQ(timeInStream(*stream_, 2s), 181'000);
  stream_->start_time = AV_NOPTS_VALUE;
  EXPECT_EQ(timeInStream(*stream_, 2s), 180'000);
}

TEST_F(StreamTimes, EndAtTheLimitsOfTheirType) {
  stream_->time_base = {1, 90'000};
  stream_->start_time = INT64_MAX - 10;
  EXPECT_EQ(timeInStream(*stream_, 2s), INT64_MAX);
  stream_->start_time = 0;
  stream_->time_base = {1, INT32_MAX};
  EXPECT_EQ(timeInStream(*stream_, Duration::max()), INT64_MAX);
  EXPECT_EQ(timeBetween(INT64_MIN + 5, 10), INT64_MIN);
  EXPECT_EQ(timeBetween(INT64_MAX, -10), INT64_MAX);
  EXPECT_EQ(timeBetween(7, 10), -3);
}

TEST(Demuxer, OpensNoOtherFile) {
  const InputContext context(makeDemuxer(nullptr));
  AVIOContext* other = nullptr;
  EXPECT_LT(context->io_open(context.get(), &other, "/etc/hostname", AVIO_FLAG_READ, nullptr), 0);
  EXPECT_EQ(other, nullptr);
}

}  // namespace
}  // namespace pleinair::hal::libav
