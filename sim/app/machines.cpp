#include "sim/app/machines.h"

#include "models/machines/rds3000/rds3000.h"

namespace dendro::app {

const std::vector<MachineType>& machines() {
  static const std::vector<MachineType> list = {rds3000::rds3000_type()};
  return list;
}

}  // namespace dendro::app
