#include "daemon/remote_devices.h"

#include <utility>

#include "daemon/devices/device_places.h"
#include "daemon/net/network_allowed.h"
#include "daemon/shm/fields.h"

namespace merlin {

Result<std::unique_ptr<RemoteDevices>> RemoteDevices::make(const Settings& settings,
                                                           std::uint64_t generation,
                                                           status::Services& services,
                                                           ThreadWatch& threads,
                                                           const Clock& clock) {
  const InputSettings& input = settings.wall.input;
  auto segment = shm::SegmentWriter<shm::DevicesSegment>::make(
      shm::segmentName(settings.instance, "devices"),
      shm::devicesFields(devices::slotNames(settings.devices)), generation, clock.now(), {});
  if (!segment) return segment.error();
  auto slots = shm::DeviceSlots::find(**segment);
  if (!slots) return slots.error();
  std::unique_ptr<RemoteDevices> devices(new RemoteDevices(*std::move(segment), *std::move(slots)));
  if (const auto allowed = net::networkAllowed(); !allowed) {
    services.failed("input", "/wall/input/endpoint: " + allowed.error().what);
    return devices;
  }
  auto keys = status::readKeyPair(input.keys);
  if (!keys) return keys.error();
  auto link = status::SampleLink::start({input.endpoint, input.server_key, *std::move(keys)},
                                        devices::slotNames(settings.devices), *devices->segment_,
                                        threads, clock);
  if (!link) return link.error();
  devices->link_ = *std::move(link);
  return devices;
}

}  // namespace merlin
