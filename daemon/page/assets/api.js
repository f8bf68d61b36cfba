// Requests to the daemon, or to several of them by their addresses.

import { by_id, show } from "./dom.js";
import * as fragment from "./fragment.js";
import { sentence, tr } from "./language.js";
import { recalled, remember } from "./memory.js";

// On another device the page does not contain the token; it is in the address, or the operator types it in.
let token = document.querySelector('meta[name="a351-token"]').content || fragment.token || recalled("token");
if (fragment.token) remember("token", fragment.token);
// A random token of this daemon is not for others.  One of the configuration is that of all boxes, and so is a typed one.
let token_for_others = document.querySelector('meta[name="a351-token-configured"]')?.content ? token : "";
const fresh_tokens = new Map(); // Tokens that daemons gave out, by their origins.

by_id("token-form").addEventListener("submit", (event) => {
    event.preventDefault();
    token = by_id("token").value;
    token_for_others = token;
    fresh_tokens.clear();
    remember("token", token);
    show("token-form", false);
});

async function asked(path, options) {
    let reply;
    try {
        reply = await fetch(path, options);
    } catch {
        if (new URL(path, location.href).origin === location.origin) throw new Error(tr("the daemon does not answer"));
        throw new Error(tr("the daemon does not answer, or its [page] boxes does not have {}", location.origin));
    }
    const body = await reply.json().catch(() => ({}));
    const said = body.error && sentence(body.error_parts, body.error);
    const trouble = reply.ok ? null : said ?? tr("the daemon answered with status {}", reply.status);
    return { is_forbidden: reply.status === 403, trouble, body };
}

/** Reads from the daemon.  @param options  of fetch.  @throws Error with a line for the operator. */
export async function get(path, query = {}, options = {}) {
    const tail = new URLSearchParams(query).toString();
    const { trouble, body } = await asked(tail ? `${path}?${tail}` : path, options);
    if (trouble) throw new Error(trouble);
    return body;
}

/** Sends an order.  @param options  of fetch.  @throws Error with a line for the operator. */
export async function post(path, order, options = {}) {
    const { origin } = new URL(path, location.href);
    const known = origin === location.origin ? token : token_for_others;
    const send = () => asked(path, {
        method: "POST",
        headers: { "Content-Type": "application/json", "X-A351-Token": fresh_tokens.get(origin) ?? known },
        body: JSON.stringify(order),
        ...options,
    });
    let answer = await send();
    if (answer.is_forbidden) {
        // A daemon that was restarted has another token.
        const fresh = await asked(`${origin}/api/token`, options);
        if (fresh.trouble) {
            show("token-form", true);
        } else {
            fresh_tokens.set(origin, fresh.body.token);
            answer = await send();
        }
    }
    if (answer.trouble) throw new Error(answer.trouble);
    return answer.body;
}
