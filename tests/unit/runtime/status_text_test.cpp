#include "pipeline/runtime/status/status_text.h"

#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

const std::vector<std::string>& levels() {
  static const std::vector<std::string> kLevels{"full", "medium"};
  return kLevels;
}

RuntimeStatus someStatus() {
  RuntimeStatus status;
  status.uptime = 90s;
  status.camera = {.state = hal::CameraState::kStreaming,
                   .reason = "frames come",
                   .camera = hal::CameraIdentity{"v4l2", "usb-1", "A \"good\"\ncamera"},
                   .format = hal::StreamFormat{.frame = {.size = {640, 480}}, .framePeriod = {}},
                   .perSecond = 30.0};
  status.painting = {
      .quality = 1, .latency = 120ms, .configuredLatency = 120ms, .hasPainter = true};
  DurationHistogram latency;
  for (int i = 0; i < 100; ++i) latency.add(121ms);
  status.painting.stages = {{"tracking", latency, 100, 12'100ms}};
  OutputStage::Status output{.name = "loopback", .submitted = 100, .perSecond = 29.9};
  output.presented = 100;
  output.latencySum = 12'100ms;
  output.latency = latency;
  output.ended.at(0) = 100;
  status.outputs = {output};
  status.ledger.captured = 103;
  status.ledger.ended.at(static_cast<std::size_t>(Outcome::kShown)) = 100;
  status.ledger.ended.at(static_cast<std::size_t>(Outcome::kReplaced)) = 3;
  return status;
}

TEST(StatusLine, SaysTheMostImportant) {
  EXPECT_EQ(statusLine(someStatus(), levels()),
            "streaming · 30.0 → 29.9 frames/s · 120 ms (p95 121) · medium · 3 dropped");
}

TEST(StatusJson, HoldsEverything) {
  const auto json = nlohmann::json::parse(statusJson(someStatus(), levels()));
  EXPECT_EQ(json["camera"]["description"], "A \"good\"\ncamera");
  EXPECT_EQ(json["camera"]["format"]["width"], 640);
  EXPECT_EQ(json["painting"]["quality"], "medium");
  EXPECT_EQ(json["painting"]["latency_ms"], 120.0);
  EXPECT_EQ(json["frames"]["captured"], 103);
  EXPECT_EQ(json["frames"]["ended"]["replaced"], 3);
  EXPECT_EQ(json["frames"]["ended"].size(), kOutcomes);
  EXPECT_EQ(json["outputs"][0]["name"], "loopback");
  EXPECT_NEAR(json["outputs"][0]["latency"]["p95_ms"], 121.0, 0.1);
  EXPECT_EQ(json["healthy"], true);
  EXPECT_EQ(json["uptime_s"], 90.0);
  EXPECT_EQ(json["camera"]["state"], "streaming");
  EXPECT_EQ(json["painting"]["stages"]["tracking"]["count"], 100);
  EXPECT_EQ(json["outputs"][0]["state"], "taking");
  EXPECT_EQ(json["outputs"][0]["ended"]["shown"], 100);
  EXPECT_EQ(json["outputs"][0]["submitted"], 100);
}

TEST(StatusJson, HoldsTheStateOfTheMachineAsFarAsItIsKnown) {
  RuntimeStatus status = someStatus();
  EXPECT_TRUE(nlohmann::json::parse(statusJson(status, levels()))["machine"].empty());
  status.machine = hal::MachineState{
      .hottest = hal::ThermalZone{.name = "gpu-thermal", .celsius = 71.5, .limitCelsius = 80},
      .usedBytes = 300'000'000,
      .availableBytes = {},
      .diskFreeBytes = 16'000'000'000,
      .clock = hal::ClockTrust::kWrong,
      .clockJumps = 2};
  status.painting.bestQuality = 1;
  const auto json = nlohmann::json::parse(statusJson(status, levels()));
  EXPECT_EQ(json["machine"]["sensor"], "gpu-thermal");
  EXPECT_EQ(json["machine"]["celsius"], 71.5);
  EXPECT_EQ(json["machine"]["limit_celsius"], 80);
  EXPECT_EQ(json["machine"]["memory_used_bytes"], 300'000'000);
  EXPECT_FALSE(json["machine"].contains("memory_available_bytes"));
  EXPECT_EQ(json["machine"]["disk_free_bytes"], 16'000'000'000);
  EXPECT_EQ(json["machine"]["clock"], "wrong");
  EXPECT_EQ(json["machine"]["clock_jumps"], 2);
  EXPECT_EQ(json["painting"]["quality_limit"], "medium");
  const std::string metrics = statusMetrics(status, levels());
  EXPECT_THAT(metrics, HasSubstr("\npleinair_machine_celsius 71.5\n"));
  EXPECT_THAT(metrics, HasSubstr("\npleinair_machine_clock_jumps_total 2\n"));
  EXPECT_THAT(metrics, HasSubstr("pleinair_machine_clock{clock=\"wrong\"} 1\n"));
  EXPECT_THAT(metrics, HasSubstr("pleinair_painting_quality_limit{quality_limit=\"medium\"} 1\n"));
}

TEST(StatusJson, LeavesOutWhatIsNotKnown) {
  RuntimeStatus status = someStatus();
  auto json = nlohmann::json::parse(statusJson(status, levels()));
  EXPECT_FALSE(json["camera"].contains("last_loss"));
  EXPECT_FALSE(json["outputs"][0].contains("last_failure"));
  status.camera.camera.reset();
  status.camera.lastLoss = "unplugged";
  status.outputs[0].failure = hal::Error{.subject = "/dev/video50", .problem = "is gone"};
  status.outputs[0].isFailed = true;
  json = nlohmann::json::parse(statusJson(status, levels()));
  EXPECT_FALSE(json["camera"].contains("id"));
  EXPECT_EQ(json["camera"]["last_loss"], "unplugged");
  EXPECT_EQ(json["outputs"][0]["last_failure"], "/dev/video50: is gone");
  EXPECT_EQ(json["outputs"][0]["state"], "reopening");
}

TEST(StatusJson, HoldsTheRefreshOfAnOutputAsFarAsItIsKnown) {
  RuntimeStatus status = someStatus();
  EXPECT_FALSE(nlohmann::json::parse(statusJson(status, levels()))["outputs"][0].contains(
      "refresh_period_s"));
  status.outputs[0].refresh = hal::Refresh{.period = 20ms, .phase = {}};
  auto output = nlohmann::json::parse(statusJson(status, levels()))["outputs"][0];
  EXPECT_EQ(output["refresh_period_s"], 0.02);
  EXPECT_FALSE(output.contains("refresh_phase_s"));
  EXPECT_EQ(output["pacing"], "clock");
  status.outputs[0].refresh->phase = hal::TimePoint(12'500ms);
  status.outputs[0].refresh->sequence = 750;
  output = nlohmann::json::parse(statusJson(status, levels()))["outputs"][0];
  EXPECT_EQ(output["refresh_phase_s"], 12.5);
  EXPECT_EQ(output["pacing"], "display");
  const std::string metrics = statusMetrics(status, levels());
  EXPECT_THAT(metrics,
              HasSubstr("pleinair_output_refresh_period_seconds{output=\"loopback\"} 0.02\n"));
  EXPECT_THAT(metrics,
              HasSubstr("pleinair_output_refresh_phase_seconds{output=\"loopback\"} 12.5\n"));
}

TEST(StatusJson, SurvivesNamesThatAreNoText) {
  RuntimeStatus status = someStatus();
  status.camera.camera->description = "\xff\xfe";
  EXPECT_NO_THROW(nlohmann::json::parse(statusJson(status, levels())));
}

/// The syntax of Prometheus's text format 0.0.4, line by line.
TEST(StatusMetrics, AreInPrometheusFormat) {
  const std::string text = statusMetrics(someStatus(), levels());
  static const std::regex kComment(
      R"(# (HELP pleinair_\w+ .+|TYPE pleinair_\w+ (counter|gauge|summary)))");
  static const std::regex kSample(
      R"((pleinair_\w+)(\{\w+="(\\.|[^"\\])*"(,\w+="(\\.|[^"\\])*")*\})? [-+.\deE]+)");
  std::istringstream lines(text);
  std::set<std::string> seen;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) {
      EXPECT_TRUE(std::regex_match(line, kComment)) << line;
    } else {
      EXPECT_TRUE(std::regex_match(line, kSample)) << line;
      EXPECT_TRUE(seen.insert(line.substr(0, line.rfind(' '))).second) << "twice: " << line;
    }
  }
  EXPECT_EQ(text.back(), '\n');
  EXPECT_THAT(text, HasSubstr("pleinair_frames_ended_total{outcome=\"replaced\"} 3\n"));
  EXPECT_THAT(text, HasSubstr("pleinair_painting_quality{quality=\"medium\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("pleinair_output_latency_seconds_sum{output=\"loopback\"} 12.1\n"));
  EXPECT_THAT(text,
              HasSubstr("pleinair_output_latency_seconds{output=\"loopback\",quantile=\"0.95\"} "
                        "0.12"));
  EXPECT_THAT(text, HasSubstr("pleinair_painting_stages_seconds_count{stage=\"tracking\"} 100\n"));
  EXPECT_THAT(text, HasSubstr("pleinair_camera_state{state=\"backing off\"} 0\n"));
  EXPECT_THAT(text, HasSubstr("pleinair_camera_state{state=\"streaming\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("pleinair_output_state{output=\"loopback\",state=\"taking\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("\npleinair_uptime_seconds 90\n"));
  EXPECT_THAT(text, HasSubstr("\npleinair_healthy 1\n"));
}

TEST(StatusMetrics, EscapeLabels) {
  RuntimeStatus status = someStatus();
  status.outputs[0].name = "a\"b\\c\nd";
  EXPECT_THAT(statusMetrics(status, levels()), HasSubstr(R"(output="a\"b\\c\nd")"));
}

TEST(RuntimeStatusTest, IsHealthyWhilePicturesComeOut) {
  RuntimeStatus status = someStatus();
  EXPECT_TRUE(status.isHealthy());
  status.camera.state = hal::CameraState::kBackingOff;
  EXPECT_FALSE(status.isHealthy());
  status = someStatus();
  status.outputs[0].perSecond = 0.0;
  EXPECT_FALSE(status.isHealthy());
}

}  // namespace
}  // namespace pleinair::runtime
