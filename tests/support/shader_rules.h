#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pleinair::support {

/// A shader as its author wrote it, and as it is compiled.
struct ShaderText {
  std::string name;          ///< its ending says the stage: .vert .frag .comp, or .glsl to include
  std::string written;       ///< the file
  std::string expanded;      ///< with its includes, without version, precisions and lines left out
  std::string variant = {};  ///< its name and the flags that it is compiled with
};

/// What breaks a rule, as sentences; empty when nothing does.
using Complaints = std::vector<std::string>;

/// Each function holds a shader to one of the rules that keep one set of shaders working on every
/// target (docs/gpu.md). They read text, not syntax: what they cannot read they refuse.

/// A head comment says purpose, inputs, outputs and precision.
Complaints headCommentRule(const ShaderText& shader);
/// No version of its own, no geometry or tessellation, no primitive ids (rule 1).
Complaints languageRule(const ShaderText& shader);
/// No storage buffer or image in vertex and fragment shaders (rules 2 and 3).
Complaints graphicsStageRule(const ShaderText& shader);
/// At most 4 colour targets (rule 3).
Complaints outputsRule(const ShaderText& shader);
/// At most 128 invocations a group, 4 storage buffers, 4 images (rule 4).
Complaints computeLimitsRule(const ShaderText& shader);
/// At most 16 KiB of shared memory (rule 4).
Complaints sharedMemoryRule(const ShaderText& shader);
/// Images of allowed formats, read-write only r32*, no atomics on images (rule 6).
Complaints imageFormatsRule(const ShaderText& shader);
/// No place in an order from an atomic counter (rule 7).
Complaints atomicOrderRule(const ShaderText& shader);
/// mediump on colours only, lowp on nothing (rule 8).
Complaints precisionRule(const ShaderText& shader);

/// All of the above.
Complaints shaderRules(const ShaderText& shader);

/// Code without comments.
std::string withoutComments(std::string_view text);
/// The value of a constant expression of + - * / and parentheses over whole numbers and the
/// `const int`s and `#define`s of `code`; throws std::invalid_argument for anything else.
long constantValue(std::string_view expression, const std::string& code);

}  // namespace pleinair::support
