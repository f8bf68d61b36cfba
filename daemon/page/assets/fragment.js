// The fragment of the address: the view, and the token when a telephone opens the page by the code that a351ctl shows.
// Browsers neither send nor log a fragment; the token is removed from it at once.

const parts = new URLSearchParams(location.hash.slice(1));

/** Token of the address, "" if there is none. */
export const token = parts.get("token") ?? "";

if (token) history.replaceState(null, "", parts.has("field") ? "#field" : "#page");
