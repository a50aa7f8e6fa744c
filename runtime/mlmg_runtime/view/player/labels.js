// What is written over the picture: the name of each file, the command, and what each graph plays.

class Labels {
  constructor(element, motions, colours) {
    this.colours = colours;
    this.panes = motions.map((motion) => {
      const pane = element.appendChild(document.createElement("div"));
      pane.className = "pane";
      const part = (kind, parent) => {
        const child = parent.appendChild(document.createElement("div"));
        child.className = kind;
        return child;
      };
      const name = part("name", pane);
      const dot = name.appendChild(document.createElement("i"));
      name.append(motion.name);
      const now = part("now", pane);
      return { pane, dot, command: part("command", now), graphs: part("graphs", now) };
    });
  }

  // Puts each file's text into its part of the window: [left, top, width, height] in CSS pixels.
  place(boxes, dots) {
    this.panes.forEach(({ pane, dot }, index) => {
      const [left, top, width, height] = boxes[index];
      Object.assign(pane.style, { left: `${left}px`, top: `${top}px`, width: `${width}px`, height: `${height}px` });
      pane.classList.toggle("together", Boolean(dots));
      dot.style.display = dots ? "" : "none";
      dot.style.background = dots ? cssColour(dots[index]) : "";
    });
  }

  show(index, motion, frame) {
    const { command, graphs } = this.panes[index];
    const now = motion.commandAt(frame);
    command.textContent = now ? now.text : "";
    command.classList.toggle("coming", Boolean(now) && frame < now.arrive);
    graphs.replaceChildren(...motion.playingAt(frame).map(({ track, index: graph, stretch }) => {
      const item = document.createElement("span");
      const name = item.appendChild(document.createElement("b"));
      name.textContent = track.graph;
      name.style.color = cssColour(this.colours.accents[graph % this.colours.accents.length]);
      item.append(stretch.text);
      return item;
    }));
  }
}

function cssColour(colour) {
  return `rgb(${colour.map((part) => Math.round(255 * part)).join(" ")})`;
}
