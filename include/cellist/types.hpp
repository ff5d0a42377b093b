// SPDX-License-Identifier: MIT
#pragma once
// Types for members and values that C++ cannot tell from others: `cl_half` is `cl_ushort`, and
// `cl_float3` is `cl_float4`.

#include <CL/cl_half.h>

#include <cellist/opencl.hpp>

namespace cellist {

/// A number in half precision. Kernels see a `cellist_half`; cellist_half_to_float() and
/// cellist_float_to_half() convert it, on devices without half arithmetic too. Halves are ordered
/// as floats: -inf < ... < -0 < +0 < ... < +inf < NaN.
struct Half {
    cl_half bits;

    /// Rounds to the nearest half, ties to even.
    [[nodiscard]] static Half of(float value) { return {cl_half_from_float(value, CL_HALF_RTE)}; }
    [[nodiscard]] float to_float() const { return cl_half_to_float(bits); }
};

/// A vector of three scalars. Kernels see a vector such as `float3`, of the size and alignment of
/// four scalars. The fourth is padding: no comparison of records counts it.
template <class T>
struct alignas(4 * sizeof(T)) Vector3 {
    T x, y, z;
};

}  // namespace cellist
