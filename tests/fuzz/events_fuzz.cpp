/// @file
/// Event logs.  A line that is accepted must read the same after it is written again, and the
/// occupations that follow from the events must keep the rules of event-format.md.

#include <vector>

#include "protocol/events/occupations.hpp"
#include "tests/fuzz/fuzz_file.hpp"

using namespace a351;
using namespace a351::events;
using fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::file_of(fuzz::text_of(data, size), "events/2026-03.jsonl");
    const EventLog log = read_events(fuzz::folder() / "events");
    for (const Event& event : log.events) {
        const auto again = parse_event(to_json(event));
        require(again && again->type == event.type && again->utc == event.utc &&
                again->session == event.session && again->index == event.index &&
                again->details == event.details);
    }
    for (const Occupation& occupation : occupations_of(log.events)) {
        require(occupation.number >= 1 && !occupation.set_ups.empty());
    }
    (void)OccupationReplay(log.events).running();
    return 0;
}
