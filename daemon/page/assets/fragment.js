// The fragment of the address: the token, when a telephone opens the page by the code that a351ctl shows.  Browsers neither send
// nor log a fragment; it is removed at once.

/** Token of the address, "" if there is none. */
export const token = new URLSearchParams(location.hash.slice(1)).get("token") ?? "";

if (token) history.replaceState(null, "", location.pathname);
