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
    finding.remedy =
        "sudo apt install libgl1-mesa-dri, or the GPU's own driver; "
        "or paint smaller: --size 320x240";
  }
  return finding;
}

}  // namespace pleinair::app::doctor
