#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pleinair::support {

/// A shader's source, as written and as compiled.
struct ShaderText {
  std::string name;          ///< its ending says the stage: .vert .frag .comp, or .glsl to include
  std::string written;       ///< the file
  std::string expanded;      ///< with its includes, without version, precisions and lines left out
  std::string variant = {};  ///< its name and the flags that it is compiled with
};

/// Violations of a rule, as sentences; empty if there are none.
using Violations = std::vector<std::string>;

/// Each function checks a shader against one of the rules that make one set of shaders work on
/// every target (docs/gpu.md). The functions read text, not syntax, and report code that they
/// cannot read.

/// The head comment states purpose, inputs, outputs and precision.
Violations headCommentRule(const ShaderText& shader);
/// No #version, no geometry or tessellation, no primitive ids (rule 1).
Violations languageRule(const ShaderText& shader);
/// No storage buffer or image in vertex and fragment shaders (rules 2 and 3).
Violations graphicsStageRule(const ShaderText& shader);
/// At most 4 colour targets (rule 3).
Violations outputsRule(const ShaderText& shader);
/// At most 128 invocations per group, 4 storage buffers, 4 images (rule 4).
Violations computeLimitsRule(const ShaderText& shader);
/// At most 16 KiB of shared memory (rule 4).
Violations sharedMemoryRule(const ShaderText& shader);
/// Images of allowed formats, read-write only r32*, no atomics on images (rule 6).
Violations imageFormatsRule(const ShaderText& shader);
/// No order that depends on an atomic counter (rule 7).
Violations atomicOrderRule(const ShaderText& shader);
/// mediump on colours only, lowp on nothing (rule 8).
Violations precisionRule(const ShaderText& shader);
/// At most 16 textures in a stage: Adreno has no more (docs/gpu.md, "Limits of the drivers").
Violations texturesRule(const ShaderText& shader);
/// No loop with a constant bound that a break cuts short (rule 19).
Violations loopBoundsRule(const ShaderText& shader);

/// A program that runs over a list of blocks returns beyond its end before anything else (rule 27).
Violations listEndRule(const ShaderText& shader);

/// All rules above.
Violations shaderRules(const ShaderText& shader);

/// The code without comments.
std::string withoutComments(std::string_view text);
/// The value of a constant expression of + - * / and parentheses over whole numbers and the
/// `const int`s and `#define`s of `code`; throws std::invalid_argument for anything else.
long constantValue(std::string_view expression, const std::string& code);

}  // namespace pleinair::support
