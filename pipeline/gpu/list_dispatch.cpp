#include "pipeline/gpu/list_dispatch.h"

#include "pipeline/gpu/egl_context.h"

namespace pleinair::gpu {

ListDispatch fasterListDispatch(const ContextInfo& context) {
  return context.renderer.starts_with("V3D") ? ListDispatch::kAllGroups : ListDispatch::kIndirect;
}

}  // namespace pleinair::gpu
