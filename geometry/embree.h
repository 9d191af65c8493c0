// The only file that includes Embree (3 or 4): its objects with owners, and its errors. What differs between the
// versions beyond that stands where it is used.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <fmt/format.h>

#include <memory>
#include <stdexcept>

namespace scree {

// Owns a reference-counted Embree object.
template <class Object, void (*release)(Object)>
struct EmbreeRelease {
  using pointer = Object;
  void operator()(Object object) const { release(object); }
};
template <class Object, void (*release)(Object)>
using EmbreeHandle = std::unique_ptr<Object, EmbreeRelease<Object, release>>;

using DeviceHandle = EmbreeHandle<RTCDevice, rtcReleaseDevice>;
using SceneHandle = EmbreeHandle<RTCScene, rtcReleaseScene>;
using GeometryHandle = EmbreeHandle<RTCGeometry, rtcReleaseGeometry>;

inline void require_no_error(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE) throw std::runtime_error(fmt::format("Embree failed with error {}", int(error)));
}

// One thread builds, so that the hierarchy, and with it every answer, is the same each time.
inline DeviceHandle embree_device() {
  DeviceHandle device(rtcNewDevice("threads=1"));
  require_no_error(device.get());
  return device;
}

}  // namespace scree
