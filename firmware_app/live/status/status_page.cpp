#include "firmware_app/live/status/status_page.h"

#include <string_view>

#include <fmt/format.h>

#include "hal/clock.h"
#include "hal/html_text.h"

namespace pleinair::app {
namespace {

using hal::htmlText;

std::string row(std::string_view name, std::string_view value) {
  return fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", htmlText(name), htmlText(value));
}

std::string cameraText(const runtime::CaptureStage::Status& camera) {
  std::string text = camera.camera ? fmt::format("{} {}", camera.camera->backend, camera.camera->id)
                                   : std::string("none yet");
  if (camera.format) {
    const hal::FrameSize size = camera.format->frame.size;
    text +=
        fmt::format(", {} × {}, {:.1f} frames a second", size.width, size.height, camera.perSecond);
  }
  if (!camera.reason.empty()) text += fmt::format(" ({})", camera.reason);
  return text;
}

std::string outputText(const runtime::OutputStage::Status& output) {
  std::string text =
      fmt::format("{} × {}, {:.1f} frames a second, {} shown", output.format.size.width,
                  output.format.size.height, output.perSecond, output.presented);
  if (output.isFailed && output.failure) text += "; " + output.failure->message();
  return text;
}

std::string uptimeText(hal::Duration uptime) {
  const auto minutes = std::chrono::duration_cast<std::chrono::minutes>(uptime).count();
  return fmt::format("{} days, {}:{:02} h", minutes / 1440, minutes / 60 % 24, minutes % 60);
}

std::string bytesText(std::uint64_t bytes) {
  constexpr double kMega = 1e6;
  constexpr double kGiga = 1e9;
  const auto amount = static_cast<double>(bytes);
  return amount < kGiga ? fmt::format("{:.0f} MB", amount / kMega)
                        : fmt::format("{:.1f} GB", amount / kGiga);
}

std::string machineText(const hal::MachineState& machine) {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (const auto& zone = machine.hottest) {
    add(fmt::format("{} at {:.0f} °C (slows down from {:.0f} °C on)", zone->name, zone->celsius,
                    zone->limitCelsius));
  }
  if (machine.usedBytes) add(bytesText(*machine.usedBytes) + " of memory used");
  if (machine.availableBytes) add(bytesText(*machine.availableBytes) + " available");
  if (machine.diskFreeBytes) add(bytesText(*machine.diskFreeBytes) + " of disk free");
  return text;
}

std::string clockText(const hal::MachineState& machine) {
  std::string text = machine.clock == hal::ClockTrust::kSynchronized ? "synchronized"
                     : machine.clock == hal::ClockTrust::kUnconfirmed
                         ? "not confirmed by a time server"
                         : "wrong: no schedule is followed";
  if (machine.clockJumps > 0) text += fmt::format("; jumped {} times", machine.clockJumps);
  return text;
}

std::string rowsOf(const runtime::RuntimeStatus& status, const std::string& style,
                   const std::vector<std::string>& qualities) {
  const runtime::PaintStage::Status& painting = status.painting;
  std::string rows = row("Camera", cameraText(status.camera)) + row("Style", style);
  if (painting.hasPainter && painting.quality < qualities.size()) {
    std::string text =
        fmt::format("{:.1f} frames a second, quality {}, {:.0f} ms latency", painting.perSecond,
                    qualities[painting.quality], hal::toMilliseconds(painting.latency));
    if (painting.bestQuality > 0 && painting.bestQuality < qualities.size()) {
      text +=
          fmt::format("; at most {} until the machine has cooled", qualities[painting.bestQuality]);
    }
    rows += row("Painting", text);
  }
  for (const runtime::OutputStage::Status& output : status.outputs) {
    rows += row("Output " + output.name, outputText(output));
  }
  if (!status.camera.lastLoss.empty()) rows += row("Last loss", status.camera.lastLoss);
  if (!status.siteOrigin.empty()) rows += row("Set up by", status.siteOrigin);
  if (!status.siteProblem.empty()) rows += row("Setting up", status.siteProblem);
  if (status.machine) {
    const std::string text = machineText(*status.machine);
    if (!text.empty()) rows += row("Machine", text);
    rows += row("Clock", clockText(*status.machine));
  }
  return rows + row("Running for", uptimeText(status.uptime));
}

constexpr std::string_view kPageHead = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="refresh" content="5">
<title>pleinair</title>
<style>
body { font: 16px/1.5 sans-serif; max-width: 46em; margin: 2em auto; padding: 0 1em;
       color: #222; background: #faf8f3; }
h1 { font-weight: normal; margin-bottom: 0; }
.state { padding: .2em .8em; border-radius: 1em; color: #fff; font-size: .6em; vertical-align: middle; }
.well { background: #3a7d44; }
.ill { background: #b3432b; }
img { width: 100%; max-width: 480px; box-shadow: 0 2px 8px #0004; display: block; margin: 1em 0; }
th { text-align: left; padding-right: 1em; vertical-align: top; font-weight: normal; color: #776; }
a { color: #24527a; }
</style>
</head>
)";

}  // namespace

std::string statusPage(const runtime::RuntimeStatus& status, const std::string& style,
                       const std::vector<std::string>& qualities) {
  const bool isWell = status.isHealthy();
  std::string html(kPageHead);
  html += fmt::format(
      "<body>\n<h1>pleinair <span class=\"state {}\">{}</span></h1>\n"
      "<p>A camera whose live picture is painted.</p>\n",
      isWell ? "well" : "ill", isWell ? "all is well" : "no pictures are shown");
  const bool hasPicture = status.painting.painted > 0;
  html += hasPicture ? "<img src=\"/painting.jpg\" alt=\"The painting a moment ago\">\n"
                     : "<p>There is no painting yet.</p>\n";
  html += fmt::format("<table>\n{}</table>\n", rowsOf(status, style, qualities));
  html +=
      "<p>For programs: <a href=\"/status\">/status</a> (JSON), <a href=\"/metrics\">/metrics</a> "
      "(Prometheus), <a href=\"/healthz\">/healthz</a> (200 or 503), "
      "<a href=\"/painting.jpg\">/painting.jpg</a>.</p>\n</body>\n</html>\n";
  return html;
}

}  // namespace pleinair::app
