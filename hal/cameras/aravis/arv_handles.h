#pragma once

#include <memory>
#include <string>

#include <arv.h>

#include "hal/error.h"

// What the files that call Aravis share: only arv_*.cpp and aravis_library.cpp include this.

namespace pleinair::hal::aravis {

/// Frees what GLib and Aravis hand over.
struct FreeObject {
  void operator()(gpointer object) const { g_object_unref(object); }
};
struct FreeMemory {
  void operator()(gpointer memory) const { g_free(memory); }
};
template <class T>
using Object = std::unique_ptr<T, FreeObject>;
template <class T>
using Allocated = std::unique_ptr<T, FreeMemory>;

/// The error that a call reports through its last argument.
class GlibError {
 public:
  GlibError() = default;
  ~GlibError() { g_clear_error(&error_); }
  GlibError(const GlibError&) = delete;
  GlibError& operator=(const GlibError&) = delete;

  GError** out() {
    g_clear_error(&error_);
    return &error_;
  }
  bool isSet() const { return error_ != nullptr; }
  Error as(std::string problem) const;

 private:
  GError* error_ = nullptr;
};

/// Null is empty.
std::string textOf(const char* text);

}  // namespace pleinair::hal::aravis
