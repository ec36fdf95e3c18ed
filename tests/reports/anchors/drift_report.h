#pragma once

#include <set>
#include <string>

namespace pleinair::marks {

/// Prints how far anchors in the workbench's picture drift from what they lie on, by what tells of
/// the motion: the picture alone, and with the bench as a plane of the scene by estimated and by
/// true poses. Of all shots, or those that are named in `parts`. Takes minutes. Precondition: a GL
/// context is current.
void reportDrifts(const std::set<std::string>& parts);

}  // namespace pleinair::marks
