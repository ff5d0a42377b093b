// SPDX-License-Identifier: MIT
#pragma once

#include <cellist/cellist.hpp>

namespace shadows {

/// What a pixel sees. The normal is 0 where it sees nothing.
struct Surface {
    cl_float4 position;  ///< and 1
    cl_float4 normal;    ///< and 0; towards the viewer
    cl_float4 albedo;    ///< linear RGB; and 1 if it blocks light, else 0
};
CELLIST_STRUCT(Surface, position, normal, albedo);

/// A mesh at its place in the world.
struct PlacedMesh {
    cl_float4 row_x, row_y, row_z;  ///< from the mesh to the world
    cl_float4 albedo;               ///< linear RGB; and 1 if it blocks light, else 0
};
CELLIST_STRUCT(PlacedMesh, row_x, row_y, row_z, albedo);

/// A triangle that blocks light.
struct Blocker {
    cl_uint instance;  ///< index of its PlacedMesh
    cl_uint triangle;  ///< of the geometry
};
CELLIST_STRUCT(Blocker, instance, triangle);

/// A source of indirect light: a disc. A sample is a square part of the reflective shadow map. One
/// emitter stands for all texels of the sample that show walls, another one for those that show
/// blockers. Positions and normals are means, by power.
struct Emitter {
    cl_float4 position;
    cl_float4 normal;  ///< of length 1; and how far above the position rays end
    cl_float4 power;   ///< reflected, linear RGB; and the square of the disc's radius
};
CELLIST_STRUCT(Emitter, position, normal, power);

/// The light, as kernels take it.
struct LightSource {
    cl_float4 position;  ///< of a spot light, and 1
    cl_float4 axis;      ///< where it shines, of length 1, and 0
    cl_float4 right;     ///< of its image, of length 1
    cl_float4 down;
    cl_float4 intensity;  ///< of a spot light in W/sr, of a directional light in W/m2; linear RGB
    cl_float side;        ///< of the image: at distance 1, or in the world if it is directional
    cl_int is_spot;
};
CELLIST_STRUCT(LightSource, position, axis, right, down, intensity, side, is_spot);

/// What the indirect light is computed from.
struct Gather {
    cl_int width, height;    ///< of the picture
    cl_int rsm_side;         ///< texels of the reflective shadow map along each axis
    cl_int samples;          ///< parts of it along each axis
    cl_int reduce;           ///< pixels of the picture for each one of buffer B, along each axis
    cl_int interleave;       ///< along each axis: neighbours in B share out the samples
    cl_int first_row, rows;  ///< of B in this batch
    cl_float bias;           ///< rays begin and end this far above the surfaces
};
CELLIST_STRUCT(Gather, width, height, rsm_side, samples, reduce, interleave, first_row, rows, bias);

}  // namespace shadows
