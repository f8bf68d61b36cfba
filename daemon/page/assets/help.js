// The help panel.  Its text is part of the page, so it needs no network.

import { by_id } from "./dom.js";

by_id("help-open").addEventListener("click", () => by_id("help").showModal());
by_id("help-close").addEventListener("click", () => by_id("help").close());
