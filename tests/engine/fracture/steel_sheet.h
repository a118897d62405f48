// A sheet of steel that may be dented, or shot through.
#pragma once

#include "engine/fracture/decide_shell.h"
#include "tests/engine/fracture/shapes.h"

namespace shatterbox::test {

inline fracture::ShellSubject steel_sheet(std::shared_ptr<const geometry::ShellElements> elements,
                                          double thickness, std::vector<int> clamped = {}) {
  fracture::ShellSubject subject;
  subject.mesh = std::make_shared<const geometry::ShellMesh>(geometry::make_shell_mesh(elements));
  subject.material = *material::find_preset("steel");
  subject.thickness = thickness;
  subject.clamped_vertices = std::move(clamped);
  fracture::prepare_subject(subject);
  return subject;
}

}  // namespace shatterbox::test
