;; Emacs with eglot (part of Emacs 29 and newer): in init.el.
(require 'project)
(defun motion-script-project (folder)
  "Return the project of FOLDER: the nearest that has an mlmg.toml."
  (let ((root (locate-dominating-file folder "mlmg.toml")))
    (and root (cons 'transient root))))
(define-derived-mode motion-script-mode prog-mode "Motion Script"
  (add-hook 'project-find-functions #'motion-script-project nil t)
  (setq-local comment-start "# ")
  (setq-local comment-start-skip "#+\\s-*"))
(add-to-list 'auto-mode-alist '("\\.ms\\'" . motion-script-mode))
(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs '(motion-script-mode . ("mlmg" "lsp" "--stdio"))))
(add-hook 'motion-script-mode-hook #'eglot-ensure)
