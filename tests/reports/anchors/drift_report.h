#pragma once

#include <set>
#include <string>

namespace pleinair::marks {

/// Prints how far anchors drift on the workbench, by source of motion: the image alone, and with
/// the bench as a plane of the scene by estimated and by true poses. For all shots, or those named
/// in `parts`. Takes minutes. Precondition: a GL context is current.
void reportDrifts(const std::set<std::string>& parts);

}  // namespace pleinair::marks
