// The health panel: the rows of the daemon, and one of the page itself.

import { by_id, make } from "./dom.js";
import { duration, number, visible } from "./format.js";
import { sentence, tr } from "./language.js";

/** Shows the panel.
    @param rows  of the daemon, with label, text, text_parts and level.
    @param page  figures of the page itself: redraw_ms, longest_redraw_ms, connected_s, losses. */
export function show_health(rows, page) {
    const shown = rows.map((row) => [tr(row.label), sentence(row.text_parts, row.text).replaceAll("degC", "°C"), row.level]);
    shown.push([tr("page"), tr("drawn in {} ms, at most {} ms; connected for {}, connections lost: {}", number(page.redraw_ms, 1),
        number(page.longest_redraw_ms, 1), duration(page.connected_s), page.losses), ""]);
    const list = by_id("health-rows");
    while (list.childElementCount > shown.length) list.lastElementChild.remove();
    while (list.childElementCount < shown.length) {
        const group = document.createElement("div");
        group.append(make("dt", ""), make("dd", ""));
        list.append(group);
    }
    shown.forEach(([label, text, level], i) => {
        const group = list.children[i];
        group.dataset.level = level;
        [label, visible(text)].forEach((said, k) => {
            if (group.children[k].textContent !== said) group.children[k].textContent = said;
        });
    });
}
