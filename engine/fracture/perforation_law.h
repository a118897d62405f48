// What energy a hole through a ductile plate takes, and with what speed the striker leaves it. The striker is
// rigid. A round or pointed one spreads the material: the stress that resists it is 2/3 Y in the thinnest
// plates, where it is Thomson's and Taylor's dishing, 2 Y where plates are from a third of its diameter to
// all of it, and grows by Bethe's cavity beyond [RD10]. A flat one shears a plug out, with Y / sqrt(3) on all
// of the plug's wall over all of the thickness, wherever that takes less: in plates thinner than 0.87
// diameters, which is Woodward's limit for plugging [Woo84] (see also [CRJ96]). Y is the flow stress of the
// material.
#pragma once

#include <vector>

#include "engine/material/material.h"

namespace shatterbox::fracture {

struct PlateHit {
  double thickness = 0.0;  // m, along the motion
  double area = 0.0;       // m2, of the striker's section
  double perimeter = 0.0;  // m, of that
  double flatness = 0.0;   // of the striker's front: 0 round, 1 flat
};

/// What is that thick, of all of something.
struct ThicknessShare {
  double thickness = 0.0;  // m, along the motion
  double share = 0.0;      // all of them are 1 together, but for where there is nothing
};

/// A plate that is not equally thick everywhere, or not there.
struct UnevenPlateHit {
  double area = 0.0;                         // m2, of the striker's section
  double perimeter = 0.0;                    // m, of that
  double flatness = 0.0;                     // of the striker's front
  std::vector<ThicknessShare> section, rim;  // of that area, and of that perimeter
};

/// Pa, at which it flows when it is torn: the tensile strength, for by then it has hardened. 0: it does not
/// yield.
double flow_stress(const material::Material& material);

/// J, that a hole takes. Grows with the thickness.
double perforation_work(const PlateHit& hit, double flow_stress);
/// The same, place by place: the material that is spread is that over the section, each part against the
/// resistance of a plate of its thickness; the wall that is sheared stands where material is at the rim.
double perforation_work(const UnevenPlateHit& hit, double flow_stress);

/// J, that a striker of `mass` kg must bring: the hole's work, and what is lost as it takes the plug along,
/// which was at rest (perfectly inelastic) [RI63].
double perforation_energy(double work, double mass, double plug_mass);

/// m/s, with which striker and plug leave a plate that is held, of a striker that came with `speed` m/s; 0:
/// it is stopped. [RI63]: m / (m + m_plug) sqrt(speed^2 - limit^2).
double residual_speed(double work, double mass, double plug_mass, double speed);

/// m/s: the speed below which it is stopped.
double ballistic_limit(double work, double mass, double plug_mass);

}  // namespace shatterbox::fracture
