// What every pass knows of the frame. World space, metres; colours linear. Mirrors render/pass/frame_block.h.
layout(std140, binding = 0) uniform FrameBlock {
  mat4 clip_from_world;
  mat4 shadow_from_world;   // to texture coordinates and depth, 0..1
  vec4 eye_exposure;        // world; w: exposure
  vec4 target_distance;     // world; w: metres from the eye
  vec4 sun;                 // unit, towards it; w: tangent of half its size
  vec4 sun_radiance;        // w: 1 if it casts shadows
  vec4 sky_radiance;        // from above; w: soft box strength
  vec4 ground_radiance;     // from below; w: 1 if there is occlusion
  vec4 box_axis[2];         // unit, towards the soft box; w: its strength
  vec4 box_right[2];        // unit, across; w: half width at unit distance
  vec4 box_up[2];           // unit, along; w: half height
  vec4 backdrop_top;        // w: glow
  vec4 backdrop_bottom;     // w: vignette
  vec4 floor_sun;           // light that the sun alone makes the floor send to the eye; w unused
  vec4 floor_sky;           // the same of everything else
  vec4 ground_colour;       // w: metres of its pattern, 0 if plain
  vec4 ground_place;        // x: height, y: fade from, z: fade to (m along ground_way from the eye), w: 1 if there is a ground
  vec4 ground_way;          // x, y: unit, the level way (x, z) into the picture; z: 1/from, w: 1/(1/from - 1/to)
  vec4 viewport;            // width, height, 1/width, 1/height (pixels)
  vec4 glow_centre;         // x, y in pixels; z: 1/reach; w: the ground's pattern
  vec4 occlusion_scale;     // view depth = y / (z - depth); w: metres that occlusion reaches
  vec4 view_ray;            // x, y: view-space slope at the picture's edge
  vec4 view_forward;        // world; a pixel's ray is forward + x * right + y * up, x and y in -1..1
  vec4 view_right;
  vec4 view_up;
  vec4 shadow_texel;        // x, y: metres a texel; z: metres of depth range; w: texels across a tile
  vec4 shadow_on_floor;     // x, y: slope of the floor in the map; w: share of light that glass takes, 0 if none casts
  vec4 scalar_range;        // x: least, y: 1/(most - least)
};
const float kPi = 3.14159265;
