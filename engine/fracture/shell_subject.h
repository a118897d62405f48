// What the stress solver has to know of a body that may break: its stiffness and how it is held.
#pragma once

#include "engine/fracture/decide_shell.h"
#include "engine/stress/shell_stiffness.h"
#include "engine/stress/shell_support.h"

namespace shatterbox::fracture {

stress::ShellProperties properties_of(const ShellSubject& subject);

/// The support of a mesh of this body. Whole elements that are held cannot turn; a border that is held, as
/// glass in the putty of a window, can: a line carries no moment. Only where all that holds the body is one
/// straight line does that line keep it from turning.
stress::ShellSupport support_of(const ShellSubject& subject, const geometry::ShellMesh& mesh);

}  // namespace shatterbox::fracture
