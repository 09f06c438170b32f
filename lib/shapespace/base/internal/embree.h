#ifndef SHAPESPACE_BASE_INTERNAL_EMBREE_H_
#define SHAPESPACE_BASE_INTERNAL_EMBREE_H_

// Embree 3 (Debian 12) and Embree 4 (Debian 13) behind one interface. CMake says which one
// it found.

#if SHAPESPACE_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <shapespace/base/error.h>

namespace shapespace::internal {

/// \throw Error with one of two sentences if the device has failed since it was asked before.
inline void CheckEmbree(RTCDevice device, const char* no_memory, const char* failure) {
  switch (rtcGetDeviceError(device)) {
    case RTC_ERROR_NONE:
      return;
    case RTC_ERROR_OUT_OF_MEMORY:
      throw Error(no_memory);
    default:
      throw Error(failure);
  }
}

/// Finds the first hit of a ray; rays of consecutive calls are expected to be close together.
inline void EmbreeIntersect(RTCScene scene, RTCRayHit* ray) {
#if RTC_VERSION_MAJOR == 3
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect1(scene, &context, ray);
#else
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect1(scene, ray, &arguments);
#endif
}

/// Sets `ray->tfar` to minus infinity if anything is hit.
inline void EmbreeOccluded(RTCScene scene, RTCRay* ray) {
#if RTC_VERSION_MAJOR == 3
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, ray);
#else
  rtcOccluded1(scene, ray, nullptr);
#endif
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_EMBREE_H_
