#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {

Finding checkGraphics(const Probes& probes) {
  Finding finding{.check = "OpenGL ES"};
  const hal::Result<gpu::ContextInfo> context = probes.graphics();
  if (!context) {
    const hal::Error& error = context.error();
    finding.verdict = Verdict::kWrong;
    finding.text = fmt::format("no context of version 3.1: {}", error.problem);
    finding.remedy = "sudo apt install libegl1 libgles2 libgl1-mesa-dri";
    return finding;
  }
  finding.text = fmt::format("{} on {}", context->version, context->renderer);
  if (context->isSoftware) {
    finding.verdict = Verdict::kWarning;
    finding.text += ": software, some 15 to 25 frames a second at 640x480";
    // Mesa is there: it paints.
    const std::vector<std::filesystem::path> nodes = probes.list("/dev/dri");
    const bool hasGpu = std::ranges::any_of(nodes, [](const std::filesystem::path& node) {
      return node.filename().string().starts_with("renderD");
    });
    finding.remedy = hasGpu ? "install the GPU's own driver, or paint smaller: --size 320x240"
                            : "paint smaller: --size 320x240";
  }
  return finding;
}

/// Both ways give the same picture: that frames are uploaded is no fault.
Finding checkFrameImport(const Probes& probes) {
  const FrameImportVerdict verdict = probes.frameImport();
  const double ms = hal::toMilliseconds(verdict.took);
  return {.check = "camera frames",
          .text = verdict.isImported
                      ? fmt::format("the GPU reads them in shared memory ({}; trial: {:.0f} ms)",
                                    verdict.reason, ms)
                      : fmt::format("are uploaded: {} (trial: {:.0f} ms)", verdict.reason, ms)};
}

Finding checkRenderNodes(const Probes& probes) {
  Finding finding{.check = "render nodes"};
  for (const std::filesystem::path& node : probes.list("/dev/dri")) {
    if (!node.filename().string().starts_with("renderD")) continue;
    const int status = probes.access(node);
    if (status == 0) {
      finding.verdict = Verdict::kOk;
      finding.text = node.string();
      finding.remedy.clear();
      return finding;
    }
    const bool isForbidden = status == EACCES || status == EPERM;
    finding.verdict = Verdict::kWrong;
    finding.text = fmt::format("{}: {}", node.string(), std::generic_category().message(status));
    finding.remedy = isForbidden ? "sudo usermod -aG render,video $USER, then log in again"
                                 : "see the kernel's log: sudo dmesg | grep -i drm";
  }
  if (finding.text.empty()) {
    finding.verdict = Verdict::kWarning;
    finding.text = "none in /dev/dri: no GPU, or its driver is not loaded";
    finding.remedy = "lspci -k | grep -A3 -i vga shows the GPU and the driver that it should have";
  }
  return finding;
}

}  // namespace pleinair::app::doctor
