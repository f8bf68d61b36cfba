// Build tool: manual_page SOURCE OUTPUT copies the source of a351d-http(7), with the list of the fields
// of the status in place of the line `.\" FIELDS`.

#include <fmt/core.h>

#include <fstream>
#include <string>

#include "daemon/page/status_fields.hpp"

namespace a351::daemon::page {
namespace {

/// Returns the entry of a field: its name, meaning, unit, row and metric.
std::string entry(const Field& field) {
    std::string name = field.path.substr(1);
    for (char& c : name)
        if (c == '/') c = '.';
    std::string text = fmt::format(".TP\n.B {}\n{}", name, field.meaning);
    if (!field.unit.empty()) text += fmt::format(" Unit {}.", field.unit);
    if (!field.shown.row.empty()) text += fmt::format(" Row {}.", field.shown.row);
    if (!field.metric.name.empty()) text += fmt::format(" Metric {}.", field.metric.name);
    return text + "\n";
}

}  // namespace
}  // namespace a351::daemon::page

int main(int argc, char** argv) {
    using namespace a351::daemon::page;
    if (argc != 3) return 2;
    std::ifstream source(argv[1]);
    std::ofstream page(argv[2]);
    for (std::string line; std::getline(source, line);) {
        if (line != ".\\\" FIELDS") {
            page << line << '\n';
            continue;
        }
        for (const Field& field : status_fields())
            if (!field.path.starts_with("/outer_oven/")) page << entry(field);
    }
    return source.eof() && page.flush() ? 0 : 1;
}
