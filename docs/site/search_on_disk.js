// Stands for Worker in a page that is opened as a file: a hidden frame of the same origin runs the
// script. The name is the one by which the theme's search knows that it runs in a frame.
class IFrameWorker extends EventTarget {
  constructor(url) {
    super();
    this.frame = document.createElement("iframe");
    this.frame.hidden = true;
    document.body.append(this.frame);
    const inside = this.frame.contentWindow;
    inside.postMessage = (data) => this.dispatchEvent(new MessageEvent("message", {data}));
    const script = inside.document.createElement("script");
    script.src = url;
    this.loaded = new Promise((resolve) => script.addEventListener("load", resolve));
    inside.document.body.append(script);
  }

  async postMessage(data) {
    await this.loaded;
    const inside = this.frame.contentWindow;
    inside.dispatchEvent(new inside.MessageEvent("message", {data}));
  }

  terminate() {
    this.frame.remove();
  }
}
window.Worker = window.IFrameWorker = IFrameWorker;
