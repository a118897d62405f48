#include "sandbox/study/motion.h"
#include "sandbox/study/stress.h"
#include "sandbox/study/study.h"

namespace shatterbox::sandbox::study {

const std::vector<Study>& studies() {
  static const std::vector<Study> list{motion_study(), stress_study()};
  return list;
}

}  // namespace shatterbox::sandbox::study
