const stream = new WebSocket(`ws://${location.host}/live`);
stream.onmessage = ({ data }) => {
    if (typeof data !== "string") return;
    document.getElementById("verdict").textContent = JSON.parse(data).status.verdict.state;
};
