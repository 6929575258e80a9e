#include "sim/app/machines.h"

#include "models/machines/pixel_planes/pixel_planes.h"
#include "models/machines/rds3000/rds3000.h"
#include "models/machines/sgi_4d35/sgi_4d35.h"

namespace dendro::app {

const std::vector<MachineType>& machines() {
  static const std::vector<MachineType> list = {rds3000::rds3000_type(), pixel_planes::pixel_planes_type(),
                                                sgi_4d35::sgi_4d35_type()};
  return list;
}

}  // namespace dendro::app
