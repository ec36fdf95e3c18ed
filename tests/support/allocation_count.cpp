#include "tests/support/allocation_count.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <span>
#include <string_view>

#include <execinfo.h>
#include <link.h>

namespace {

/// The address range of a module's code.
struct Module {
  std::uintptr_t begin = 0;
  std::uintptr_t end = 0;
  bool holds(const void* address) const {
    const auto at = reinterpret_cast<std::uintptr_t>(address);
    return at >= begin && at < end;
  }
};

struct Modules {
  Module program;
  Module library;  // libstdc++
  Module system;   // libc, which starts threads and main()
};

Module mappedAt(const dl_phdr_info& info) {
  Module module{.begin = ~std::uintptr_t{0}};
  for (int i = 0; i < info.dlpi_phnum; ++i) {
    const ElfW(Phdr)& part = info.dlpi_phdr[i];
    if (part.p_type != PT_LOAD) continue;
    module.begin = std::min<std::uintptr_t>(module.begin, info.dlpi_addr + part.p_vaddr);
    module.end = std::max<std::uintptr_t>(module.end, info.dlpi_addr + part.p_vaddr + part.p_memsz);
  }
  return module;
}

int addModule(dl_phdr_info* info, std::size_t, void* found) {
  Modules& modules = *static_cast<Modules*>(found);
  if (modules.program.end == 0) modules.program = mappedAt(*info);  // the program comes first
  const std::string_view name(info->dlpi_name);
  if (name.find("/libstdc++.so") != std::string_view::npos) modules.library = mappedAt(*info);
  if (name.find("/libc.so") != std::string_view::npos) modules.system = mappedAt(*info);
  return 0;
}

constexpr std::size_t kSites = 16;

std::atomic<bool> counting = false;
std::atomic<int> allocations = 0;
Modules modules;
std::array<std::atomic<const void*>, kSites> sites;
thread_local bool judging = false;

/// The address in the program's own code that requested an allocation; null if a library did.
/// `caller` is the return address of operator new. Frames of the C++ library in between are
/// skipped. A function of this program below a library's frame does not count: no library calls the
/// program back while frames are painted, but the linker shares templates such as std::vector's.
const void* requestedFrom(const void* caller) {
  std::array<void*, 48> frames{};
  const int count = backtrace(frames.data(), static_cast<int>(frames.size()));
  const std::span<void*> all(frames.data(), static_cast<std::size_t>(count));
  const auto own = [](const void* at) { return modules.program.holds(at); };
  const auto asking = std::find_if(std::ranges::find(all, caller), all.end(),
                                   [](const void* at) { return !modules.library.holds(at); });
  if (asking == all.end() || !own(*asking)) return nullptr;
  const auto entry = std::find_if_not(asking, all.end(), own);
  const bool isEnteredByLibrary =
      entry != all.end() && !modules.library.holds(*entry) && !modules.system.holds(*entry);
  return isEnteredByLibrary ? nullptr : *asking;
}

void judge(const void* caller) {
  if (!counting || judging) return;
  judging = true;
  if (const void* const place = requestedFrom(caller)) {
    const auto number = static_cast<std::size_t>(allocations++);
    if (number < kSites) sites[number] = place;
  }
  judging = false;
}

void* allocate(std::size_t size) {
  if (void* const memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}

void* allocate(std::size_t size, std::align_val_t alignment) {
  const auto step = static_cast<std::size_t>(alignment);
  if (void* const memory = std::aligned_alloc(step, (size + step - 1) / step * step)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) {
  judge(__builtin_return_address(0));
  return allocate(size);
}
void* operator new[](std::size_t size) {
  judge(__builtin_return_address(0));
  return allocate(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  judge(__builtin_return_address(0));
  return allocate(size, alignment);
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  judge(__builtin_return_address(0));
  return allocate(size, alignment);
}
// The driver's LLVM allocates with these and frees with operator delete.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  judge(__builtin_return_address(0));
  return std::malloc(size == 0 ? 1 : size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  judge(__builtin_return_address(0));
  return std::malloc(size == 0 ? 1 : size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace pleinair::support {

int allocationsIn(const std::function<void()>& work) {
  modules = {};
  dl_iterate_phdr(&addModule, &modules);
  std::array<void*, 1> once{};
  backtrace(once.data(), 1);  // the first call loads the libraries that it needs
  allocations = 0;
  counting = true;
  work();
  counting = false;
  return allocations;
}

std::string allocationSites() {
  std::string text;
  const auto known = std::min(static_cast<std::size_t>(allocations), kSites);
  for (std::size_t i = 0; i < known; ++i) {
    std::array<char, 32> offset{};
    std::snprintf(offset.data(), offset.size(), " 0x%zx",
                  reinterpret_cast<std::uintptr_t>(sites[i].load()) - modules.program.begin);
    text += offset.data();
  }
  return text;
}

}  // namespace pleinair::support
