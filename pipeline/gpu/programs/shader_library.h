#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/gpu/programs/embedded_shader.h"
#include "pipeline/gpu/programs/list_dispatch.h"
#include "pipeline/gpu/programs/pass_form.h"
#include "pipeline/gpu/programs/program.h"

namespace pleinair::gpu {

/// Where a line of an expanded text comes from.
struct SourceLine {
  std::string file;
  int line = 0;
};

/// A compiler's log that tells places in the files people edit: "0:40(7): …" as Mesa has it and
/// "0(40) : …" as NVIDIA has it become "file:3(7): …", `lines[39]` being line 3 of the file.
/// (`#line` would be simpler, but Mesa forgets the file's number.)
std::string nameLinesOfLog(const std::string& log, std::span<const SourceLine> lines);

/// A macro that the shaders of a program are compiled with, by which one file makes several
/// programs: `#define NAME VALUE` before the text. Without a value it is a flag, for `#ifdef`, and
/// part of the program's name.
struct ShaderDefine {
  std::string name;
  std::string value = {};
};
using ShaderDefines = std::vector<ShaderDefine>;

/// Shader texts by name, and programs made from them. A name is the file's path from the top of the
/// tree ("pipeline/gpu/shaders/fullscreen.vert"). A file of that path below the override directory
/// takes the embedded text's place, for live editing.
///
/// Texts are without `#version` and default precisions, which are put before them; a line
/// `#include "name"` takes in another text of the library (once each), unless an `#ifdef` leaves
/// it out.
///
/// A program is compiled at its first request and kept until the library is destroyed; further
/// requests for the same shaders and defines get a copy of it, so that a style that is set up again
/// (another look, another size) compiles nothing. Programs belong to one GL context, in which the
/// library is destroyed once it has made any.
class ShaderLibrary {
 public:
  /// Throws hal::Failure (kNotFound) where the override directory is not there.
  explicit ShaderLibrary(std::filesystem::path overrideDirectory = {});

  /// Adds a module's shaders: `library.add(gpuShaders())`. The texts outlive the library.
  void add(std::span<const EmbeddedShader> shaders);

  /// A full-screen pass: shaders/fullscreen.vert and this fragment shader. Where `targets`, the
  /// formats of what it is drawn into, are given, it may have its compute form (setPassForm).
  Program fragmentPass(std::string_view fragmentName, const ShaderDefines& defines = {},
                       const PassTargets& targets = {}) const;
  Program compute(std::string_view computeName, const ShaderDefines& defines = {}) const;
  Program draw(std::string_view vertexName, std::string_view fragmentName,
               const ShaderDefines& defines = {}) const;
  /// How many programs it has compiled so far.
  std::size_t compiledPrograms() const { return compiled_; }

  /// From now on, each run of the programs of this library, made before or after, is timed by
  /// `timer`, which outlives that; null: by none, as at first. On the thread of the programs.
  void setTimer(PassTimer* timer) { *timer_ = timer; }

  /// The form of full-screen passes that are made from now on. Precondition of kCompute:
  /// hasComputeForm().
  void setPassForm(PassForm form) { passForm_ = form; }
  /// How programs that are made from now on run over lists.
  void setListDispatch(ListDispatch how) { listDispatch_ = how; }

  /// From now on, `isCancelled` is asked before each program is compiled, which throws a
  /// hal::Failure (kCancelled) where it says so; null: nothing is asked, as at first.
  void setCancellation(std::function<bool()> isCancelled) { isCancelled_ = std::move(isCancelled); }
  /// Asks it, for other long work.
  void throwIfCancelled() const;

  /// The text as the compiler gets it: version, precisions, defines, includes.
  /// Throws hal::Failure for an unknown name or include, as the programs above do, and they
  /// also for a text that does not compile or link, with the compiler's log, and all for a file of
  /// the override directory that cannot be read.
  std::string expanded(std::string_view name, const ShaderDefines& defines = {}) const;

 private:
  std::string text(std::string_view name, std::string_view includer) const;
  struct Expansion {
    std::string text;
    std::vector<SourceLine> lines;
    std::vector<std::string> files;
    ShaderConditions conditions;
  };
  Expansion expand(std::string_view name, const ShaderDefines& defines) const;
  void expandInto(std::string_view name, std::string_view includer, Expansion& output) const;
  Program computePass(std::string_view fragmentName, const ShaderDefines& defines,
                      const PassTargets& targets) const;
  Program made(const std::string& key, const std::function<Program()>& make) const;
  ShaderHandle compile(GLenum stage, std::string_view name, const Expansion& source) const;
  /// `targets`: of a pass in its compute form.
  Program link(ProgramKind kind, std::span<const ShaderHandle> shaders, std::string label,
               std::span<const Expansion* const> sources, const PassTargets& targets = {}) const;

  std::filesystem::path overrideDirectory_;
  std::vector<EmbeddedShader> shaders_;
  std::function<bool()> isCancelled_;
  PassForm passForm_ = PassForm::kFragment;
  ListDispatch listDispatch_ = ListDispatch::kIndirect;
  Program::TimerSlot timer_ = std::make_shared<PassTimer*>(nullptr);
  mutable std::map<std::string, Program> programs_;  // by keyOf()
  mutable std::size_t compiled_ = 0;
};

}  // namespace pleinair::gpu
