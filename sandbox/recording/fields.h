// Every field of what a picture is made of, in the order of the file: for ByteWriter and ByteReader alike.
// Who adds a field to one of these structures meets its size here, and adds it to its list.
#pragma once

#include "render/frame/frame.h"

namespace shatterbox::sandbox::recording {

/// One of the looks of a draw.
template <class Archive, class Look>
void pass_look(Archive& archive, Look& look) {
  static_assert(sizeof(render::Look) == 104);
  archive(look.outside), archive(look.inside), archive(look.crack);
  archive(look.roughness), archive(look.metalness);
  archive(look.inside_roughness), archive(look.inside_metalness), archive(look.crack_roughness);
  archive(look.clear_coat), archive(look.clear_coat_roughness), archive(look.transmission);
  archive.choice(look.pattern, render::Pattern::grain_z);
  archive(look.pattern_colour), archive(look.pattern_metalness);
  archive(look.pattern_size), archive(look.pattern_centre);
}

template <class Archive, class Camera>
void pass_camera(Archive& archive, Camera& camera) {
  static_assert(sizeof(render::Camera) == 44);
  archive(camera.position), archive(camera.target), archive(camera.up);
  archive(camera.vertical_fov), archive(camera.least_aspect);
}

template <class Archive, class Lights>
void pass_lights(Archive& archive, Lights& lights) {
  static_assert(sizeof(render::Lights) == 68);
  archive(lights.sun_direction), archive(lights.sun_colour);
  archive(lights.sun_strength), archive(lights.sun_size);
  archive(lights.sky_colour), archive(lights.ground_colour);
  archive(lights.sky_strength), archive(lights.softbox_strength), archive(lights.casts_shadow);
}

template <class Archive, class Ground>
void pass_ground(Archive& archive, Ground& ground) {
  static_assert(sizeof(render::Ground) == 36);
  archive(ground.height), archive(ground.colour), archive(ground.fade_from), archive(ground.fade_to);
  archive.choice(ground.pattern, render::GroundPattern::concrete);
  archive(ground.pattern_size), archive(ground.id);
}

template <class Archive, class Backdrop>
void pass_backdrop(Archive& archive, Backdrop& backdrop) {
  static_assert(sizeof(render::Backdrop) == 36);
  archive(backdrop.top), archive(backdrop.bottom);
  archive(backdrop.glow), archive(backdrop.vignette), archive(backdrop.sweep);
}

template <class Archive, class Overlay>
void pass_overlay(Archive& archive, Overlay& overlay) {
  static_assert(sizeof(render::Overlay) == 16 + 2 * sizeof(std::string) + 8);
  archive.choice(overlay.kind, render::OverlayKind::groups);
  archive(overlay.least), archive(overlay.most), archive(overlay.title), archive(overlay.unit);
  archive(overlay.has_wires);
}

/// Everything of a picture but its draws.
template <class Archive, class Frame>
void pass_stage(Archive& archive, Frame& frame) {
  pass_camera(archive, frame.camera);
  pass_lights(archive, frame.lights);
  archive.presence(frame.ground);
  if (frame.ground) pass_ground(archive, *frame.ground);
  pass_backdrop(archive, frame.backdrop);
  pass_overlay(archive, frame.overlay);
  archive(frame.exposure), archive(frame.title.text), archive(frame.title.opacity), archive(frame.caption);
}

/// All of a mesh but its id and its triangles.
template <class Archive, class Mesh>
void pass_mesh(Archive& archive, Mesh& mesh) {
  static_assert(sizeof(render::Mesh) == 24 + 6 * sizeof(std::vector<int>));
  archive.choice(mesh.surface, render::Surface::solid);
  archive(mesh.thickness), archive(mesh.crease_angle);
  archive.array(mesh.positions), archive.array(mesh.parts), archive.array(mesh.cracks);
  archive.array(mesh.normals), archive.array(mesh.pattern_positions);
}

}  // namespace shatterbox::sandbox::recording
