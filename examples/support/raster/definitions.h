// SPDX-License-Identifier: MIT
// What host and device agree on. Compiled by C++ and by OpenCL C.
//
// Screen coordinates count sub-pixels of 1/256 pixel, x to the right and y down, from the upper
// left corner of the image. Clip coordinates (x, y, w) are relative to the centre of the image: x /
// w and y / w are sub-pixels, w is the depth along the viewing direction.
#ifndef RASTER_DEFINITIONS_H
#define RASTER_DEFINITIONS_H

#define RASTER_SUBPIXEL_BITS 8
#define RASTER_SUBPIXELS 256
// Largest side of an image in pixels.
#define RASTER_SIDE_MAX 16384
// Triangles are clipped to this many sub-pixels to each side of the image's centre: twice the
// largest image. Differences of snapped coordinates then take 25 bits, edge functions 51.
#define RASTER_GUARD 4194304.0f

// Where the samples of a pixel lie: offsets from its centre in 1/16 pixel. The patterns of 2, 4 and
// 8 samples are the standard ones of Direct3D 11; a single sample is the centre.
#define RASTER_OFFSETS_1                                                                           \
    { 0, 0 }
#define RASTER_OFFSETS_2                                                                           \
    {4, 4}, { -4, -4 }
#define RASTER_OFFSETS_4                                                                           \
    {-2, -6}, {6, -2}, {-6, 2}, { 2, 6 }
#define RASTER_OFFSETS_8                                                                           \
    {1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, { 7, -7 }

// The unit of the offsets, and the greatest of them, in sub-pixels.
#define RASTER_OFFSET_UNIT 16
#define RASTER_REACH 112

#endif
