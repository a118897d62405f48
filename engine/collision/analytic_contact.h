// Contacts of bodies with closed forms: plane, sphere and box. Solid, so that the gap has a sign and the
// direction is known even where the surfaces touch or cross a little.
#pragma once

#include <vector>

#include "engine/body/shape.h"
#include "engine/collision/collider.h"
#include "engine/collision/contact.h"
#include "engine/core/vec.h"

namespace shatterbox::collision {

/// Vertices of a (positions in the world) above or below the plane y = 0 of `plane`'s frame, closer than
/// `margin`. Only those that no neighbouring vertex undercuts.
void find_plane_contacts(const Collider& a, const std::vector<Vec3>& positions_a, const Pose& plane,
                         double margin, std::vector<Contact>& out);

/// True for pairs of spheres and boxes.
bool is_analytic_pair(body::ShapeKind a, body::ShapeKind b);

/// Contacts of spheres and boxes at these poses with gaps below `margin`. Box against box by separating axes
/// and clipping.
void find_analytic_contacts(const body::Shape& a, const Pose& pose_a, const body::Shape& b,
                            const Pose& pose_b, double margin, std::vector<Contact>& out);

/// The one contact of a sphere with a sphere or a box, however far apart.
Contact find_ball_contact(const body::Shape& a, const Pose& pose_a, const body::Shape& b, const Pose& pose_b);

/// A lower bound of the distance of such a pair, positive if they are apart by however little, negative when
/// they overlap; `normal` gets its direction (b to a).
double analytic_gap(const body::Shape& a, const Pose& pose_a, const body::Shape& b, const Pose& pose_b,
                    Vec3& normal);

/// Of two boxes: the gap along the axis of which `find_analytic_contacts` tells the contacts. It may be less
/// than theirs, for faces go before edges.
double box_contact_gap(const body::Shape& a, const Pose& pose_a, const body::Shape& b, const Pose& pose_b);

}  // namespace shatterbox::collision
