#include "pipeline/gpu/programs/list_dispatch.h"

#include "pipeline/gpu/context/egl_context.h"

namespace pleinair::gpu {

ListDispatch fasterListDispatch(const ContextInfo& context) {
  return context.renderer.starts_with("V3D") ? ListDispatch::kAllGroups : ListDispatch::kIndirect;
}

}  // namespace pleinair::gpu
