#include "firmware_app/live/status/live_reporter.h"

#include <algorithm>
#include <memory>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

namespace pleinair::app {
namespace {

using runtime::OutputStage;
using testing::HasSubstr;
using testing::Not;

/// Collects the log messages of a reporter.
class LiveReporterTest : public testing::Test {
 protected:
  LiveReporterTest() {
    spdlog::set_default_logger(std::make_shared<spdlog::logger>(
        "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(log_)));
  }
  ~LiveReporterTest() override { spdlog::set_default_logger(before_); }

  static OutputStage::Status output(const std::string& name, bool isFailed) {
    OutputStage::Status status{.name = name};
    status.isFailed = isFailed;
    if (isFailed) {
      status.failures = 1;
      status.failure = hal::Error{.subject = name, .problem = "is gone"};
    }
    return status;
  }
  /// The messages about these outputs, painted at full quality.
  std::string update(std::vector<OutputStage::Status> outputs) {
    log_.str({});
    runtime::RuntimeStatus status;
    status.outputs = std::move(outputs);
    reporter_.update(status, hal::TimePoint{});
    return log_.str();
  }

 private:
  std::ostringstream log_;
  std::shared_ptr<spdlog::logger> before_ = spdlog::default_logger();
  LiveReporter reporter_{{"full"}};
};

TEST_F(LiveReporterTest, ReportsFailuresOfOutputsThatComeAndGo) {
  EXPECT_THAT(update({output("a", false)}), Not(HasSubstr("is gone")));
  EXPECT_THAT(update({output("a", false), output("b", true)}), HasSubstr("b: is gone"));
  EXPECT_THAT(update({output("b", true)}), Not(HasSubstr("b: is gone"))) << "reported before";
  EXPECT_THAT(update({output("c", false), output("b", false)}), HasSubstr("b: takes images again"));
}

}  // namespace
}  // namespace pleinair::app
