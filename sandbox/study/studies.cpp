#include "sandbox/study/contact.h"
#include "sandbox/study/dynamics.h"
#include "sandbox/study/fragments.h"
#include "sandbox/study/motion.h"
#include "sandbox/study/refine.h"
#include "sandbox/study/scaling.h"
#include "sandbox/study/step_size.h"
#include "sandbox/study/stress.h"
#include "sandbox/study/study.h"

namespace shatterbox::sandbox::study {

const std::vector<Study>& studies() {
  static const std::vector<Study> list{motion_study(), stress_study(),    contact_study(),  step_size_study(),
                                       refine_study(), fragments_study(), dynamics_study(), scaling_study()};
  return list;
}

}  // namespace shatterbox::sandbox::study
