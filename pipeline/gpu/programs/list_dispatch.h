#pragma once

namespace pleinair::gpu {

struct ContextInfo;

/// How a program runs over a list whose length the GPU finds (Program::dispatchListed): as an
/// indirect dispatch of as many groups as the list takes, or of as many as it might take, which
/// return beyond it.
enum class ListDispatch { kIndirect, kAllGroups };

/// The faster one on a context's GPU. kAllGroups on V3D (Raspberry Pi): Mesa's driver maps the
/// command of an indirect dispatch, and waits for the pass that writes it (v3d_launch_grid).
/// kIndirect on all others: software renderers go through a whole program also in a group that
/// returns at once.
ListDispatch fasterListDispatch(const ContextInfo& context);

}  // namespace pleinair::gpu
