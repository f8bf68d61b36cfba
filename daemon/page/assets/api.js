// Questions and orders to the daemon.

const token = document.querySelector('meta[name="a351-token"]').content;

async function answer_of(request) {
    let reply;
    try {
        reply = await request;
    } catch {
        throw new Error("the daemon does not answer");
    }
    const body = await reply.json().catch(() => ({}));
    if (!reply.ok) throw new Error(body.error ?? `the daemon answers ${reply.status}`);
    return body;
}

/** @throws Error with a line for the operator. */
export function get(path, query = {}) {
    const tail = new URLSearchParams(query).toString();
    return answer_of(fetch(tail ? `${path}?${tail}` : path));
}

/** @throws Error with a line for the operator. */
export function post(path, body) {
    return answer_of(fetch(path, {
        method: "POST",
        headers: { "Content-Type": "application/json", "X-A351-Token": token },
        body: JSON.stringify(body),
    }));
}
